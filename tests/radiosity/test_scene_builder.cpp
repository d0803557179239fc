#include "radiosity/scene_builder.h"

#include "mesh/input_error.h"
#include "support/catch.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

Material of_reflectance(double reflectance) {
    Material material;
    material.reflectance = {reflectance};
    return material;
}

}  // namespace

TEST_CASE("A shape's faces become surfaces with names, and its openings let light pass",
          "[scene_builder]") {
    Scene scene;
    add_surface(scene, "lamp", mesh::rectangle({1, 1, 2}, {0, 1, 0}, {1, 0, 0}),
                of_reflectance(0.1));
    add_surface(scene, "room",
                mesh::room({0, 0, 0}, {4, 3, 3}, {{"x0", {"window", {1, 1}, {1, 1}}}}),
                of_reflectance(0.7), of_reflectance(0.0));
    std::vector<std::string> names;
    for (const auto& surface : scene.surfaces) {
        names.push_back(surface.name);
        for (const auto& polygon : surface.polygons) CHECK(polygon.name == surface.name);
    }
    CHECK(names == std::vector<std::string>{"lamp", "room.floor", "room.ceiling", "room.x0",
                                            "room.x1", "room.y0", "room.y1", "room.window"});
    CHECK_FALSE(scene.surfaces.back().material);
    const auto& wall = scene.materials.at(scene.surfaces[1].material.value());
    CHECK(wall.name == "room");
    CHECK(wall.reflectance == Spectrum{0.7});
    const auto& behind = scene.materials.at(wall.back.value());
    CHECK(behind.name == "room back");
    CHECK(behind.reflectance == Spectrum{0.0});
    const auto& lamp = scene.materials.at(scene.surfaces[0].material.value());
    CHECK(lamp.reflectance == Spectrum{0.1});
    CHECK_FALSE(lamp.back);
}

TEST_CASE("A name is taken once, and a refused shape leaves the scene as it was",
          "[scene_builder]") {
    Scene scene;
    const auto square = mesh::rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    add_surface(scene, "square", square, of_reflectance(0.5));
    CHECK_THROWS_AS(add_surface(scene, "square", square, of_reflectance(0.5)), mesh::InputError);
    CHECK(scene.surfaces.size() == 1);
    CHECK(scene.materials.size() == 1);
}
