// What differs between two scenes, and how much must be computed anew for it.
#include "radiosity/compare_scenes.h"

#include <functional>

#include "support/catch.h"
#include "support/rooms.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

Scene with_lights() {
    Scene scene = test::slit_room();
    scene.materials[1].name = "lamp";
    scene.media[0].emission = {0.5};
    scene.lights = {{"sun", Sun{{1, 0, -1}, {100.0}, 0.01}, ""},
                    {"bulb", PointLight{{1, 1, 1}, {5.0}}, ""},
                    {"beam", SpotLight{{1, 1, 1}, {0, 0, -1}, {5.0}, 0.5, 0.1}, ""}};
    scene.environment = {1.0};
    scene.viewpoints = {{0.5, 0.5, 0.5}};
    return scene;
}

struct EditCase {
    SceneChange change;
    std::string what;
    std::function<void(Scene&)> edit;
};

}  // namespace

TEST_CASE("Scenes are compared by what must be computed anew", "[animation]") {
    const Scene before = with_lights();
    const EditCase cases[] = {
        {SceneChange::emission, "emission of material \"lamp\"",
         [](Scene& s) { s.materials[1].emission = {3.0}; }},
        {SceneChange::optics, "emission of material \"lamp\"",
         [](Scene& s) { s.materials[1].emission.clear(); }},
        {SceneChange::optics, "reflectance of material \"lamp\"",
         [](Scene& s) { s.materials[1].reflectance = {0.1}; }},
        {SceneChange::lights, "emitting sides of material \"lamp\"",
         [](Scene& s) { s.materials[1].emits = EmittingSides::both; }},
        {SceneChange::geometry, "back of material \"lamp\"",
         [](Scene& s) { s.materials[1].back = 0; }},
        {SceneChange::emission, "emission of medium \"haze\"",
         [](Scene& s) { s.media[0].emission = {0.0}; }},
        {SceneChange::optics, "extinction of medium \"haze\"",
         [](Scene& s) { s.media[0].extinction = {0.3}; }},
        {SceneChange::geometry, "extinction of medium \"haze\"",
         [](Scene& s) { s.media[0].extinction = {0.0}; }},
        {SceneChange::optics, "albedo of medium \"haze\"",
         [](Scene& s) { s.media[0].albedo = {0.5}; }},
        {SceneChange::optics, "heat of medium \"haze\"", [](Scene& s) { s.media[0].heat = {0.0}; }},
        {SceneChange::geometry, "at of medium \"haze\"",
         [](Scene& s) { s.media[0].at = Point(1, 1, 1); }},
        {SceneChange::emission, "irradiance of light \"sun\"",
         [](Scene& s) { std::get<Sun>(s.lights[0].source).irradiance = {1.0}; }},
        {SceneChange::lights, "direction of light \"sun\"",
         [](Scene& s) {
             std::get<Sun>(s.lights[0].source).direction = {1, 0, -2};
         }},
        {SceneChange::emission, "intensity of light \"bulb\"",
         [](Scene& s) { std::get<PointLight>(s.lights[1].source).intensity = {1.0}; }},
        {SceneChange::lights, "position of light \"bulb\"",
         [](Scene& s) { std::get<PointLight>(s.lights[1].source).position.x = 0.7; }},
        {SceneChange::lights, "angle of light \"beam\"",
         [](Scene& s) { std::get<SpotLight>(s.lights[2].source).angle = 0.6; }},
        {SceneChange::lights, "kind of light \"beam\"",
         [](Scene& s) {
             s.lights[2].source = PointLight{{1, 1, 1}, {5.0}};
         }},
        {SceneChange::lights, "number of lights", [](Scene& s) { s.lights.pop_back(); }},
        {SceneChange::emission, "environment", [](Scene& s) { s.environment = {2.0}; }},
        {SceneChange::geometry, "shape of surface \"left\"",
         [](Scene& s) {
             s.surfaces[test::surface_named(s, "left")].polygons[0].corners[0].y = 0.1;
         }},
        {SceneChange::geometry, "material of surface \"left\"",
         [](Scene& s) { s.surfaces[test::surface_named(s, "left")].material = 1; }},
        {SceneChange::geometry, "viewpoints", [](Scene& s) { s.viewpoints.clear(); }},
    };
    for (const EditCase& one : cases) {
        Scene after = before;
        one.edit(after);
        INFO(one.what);
        const auto difference = compare_scenes(before, after);
        CHECK(difference.change == one.change);
        REQUIRE(difference.what.size() == 1);
        CHECK(difference.what[0] == one.what);
    }
}

TEST_CASE("The worst of several differences counts, names and places do not", "[animation]") {
    const Scene before = with_lights();
    Scene after = before;
    after.title = "another";
    after.materials[0].where = "a.toml:1:1";
    CHECK(compare_scenes(before, after).change == SceneChange::nothing);
    after.environment = {3.0};
    after.media[0].albedo = {0.1};
    after.materials[1].emission = {1.0};
    const auto difference = compare_scenes(before, after);
    CHECK(difference.change == SceneChange::optics);
    CHECK(difference.what.size() == 3);
}

TEST_CASE("Where temperatures are found, emission is not linear", "[animation]") {
    Scene before = with_lights();
    before.materials[0].flux = {0.0};
    Scene after = before;
    CHECK(compare_scenes(before, after).change == SceneChange::nothing);
    after.materials[1].emission = {1.0};
    CHECK(compare_scenes(before, after).change == SceneChange::optics);
}
