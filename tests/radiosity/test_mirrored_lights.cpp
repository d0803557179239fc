// Lights without a size, in flat mirrors.
#include "radiosity/mirrored_lights.h"

#include <numbers>

#include "radiosity/direct_light.h"
#include "radiosity/light_sources.h"
#include "support/box_mesh.h"
#include "support/catch.h"
#include "support/mirror_scenes.h"

using namespace tyndall;
using namespace tyndall::radiosity;
using std::numbers::pi;

namespace {

// A black foggy box of 2 × 1 × 1 m with a point light; mirrors at x1, and at x0 if asked for.
Scene lit_box(double specular, bool both) {
    Scene scene;
    scene.materials = {test::material(0.0), test::mirror(specular)};
    test::add_surfaces(scene, "room", mesh::room({0, 0, 0}, {2, 1, 1}), 0);
    scene.surfaces[test::surface_named(scene, "room.x1")].material = 1;
    if (both) scene.surfaces[test::surface_named(scene, "room.x0")].material = 1;
    scene.media = {test::medium(0.4, 0.9)};
    scene.lights = {{"bulb", PointLight{{1.3, 0.5, 0.6}, {5.0}}}};
    return scene;
}

const Point bulb{1.3, 0.5, 0.6};

double on_floor(const Enclosure& e, Point x) {
    double incident = -1.0;
    DirectLight(e).at_patch(x, {0, 0, 1}, test::tet_at(e.mesh, x, {0, 0, 1}), {&incident, 1});
    return incident;
}

double in_fog(const Enclosure& e, Point x) {
    double incident = -1.0;
    DirectLight(e).at_zone(x, test::tet_at(e.mesh, x), {&incident, 1});
    return incident;
}

// From a light of 5 W/sr at p, in the fog.
double from(Point p, Point x, bool floor) {
    const Point d = p - x;
    const double r = glm::length(d);
    const double cosine = floor ? d.z / r : 0.25;
    return 5.0 * cosine * std::exp(-0.4 * r) / (pi * r * r);
}

}  // namespace

TEST_CASE("A point light in one mirror is two point lights", "[direct]") {
    const auto e = make_enclosure(lit_box(0.8, false));
    const Point image{2.7, 0.5, 0.6};
    for (const Point x : {Point(0.3, 0.2, 0), Point(1.1, 0.71, 0), Point(1.97, 0.5, 0)})
        CHECK(on_floor(e, x) ==
              Approx(from(bulb, x, true) + 0.8 * from(image, x, true)).epsilon(1e-6));
    for (const Point x : {Point(0.31, 0.22, 0.4), Point(1.13, 0.71, 0.9), Point(1.98, 0.53, 0.2)})
        CHECK(in_fog(e, x) ==
              Approx(from(bulb, x, false) + 0.8 * from(image, x, false)).epsilon(1e-6));
}

TEST_CASE("A point light between two mirrors is a row of them", "[direct]") {
    const auto e = make_enclosure(lit_box(0.7, true));
    for (const Point x : {Point(0.3, 0.2, 0), Point(1.1, 0.71, 0)}) {
        double expected = 0.0;
        // Images at ±1.3 + 4 k, after as many reflections as walls lie between. Those that are left
        // out have a thousandth of the light's power each, and are far.
        for (int k = -20; k <= 20; ++k) {
            expected += std::pow(0.7, std::abs(2 * k)) * from({1.3 + 4 * k, 0.5, 0.6}, x, true);
            const int met = k > 0 ? 2 * k - 1 : 1 - 2 * k;
            expected += std::pow(0.7, met) * from({-1.3 + 4 * k, 0.5, 0.6}, x, true);
        }
        CHECK(on_floor(e, x) == Approx(expected).epsilon(1e-5));
    }
}

TEST_CASE("What stands in the way of a mirror's light casts a shadow", "[direct]") {
    Scene scene = lit_box(0.8, false);
    // Between the floor at x = 0.5 and the mirror, but not before the light itself.
    test::add_surfaces(scene, "screen", mesh::rectangle({1.6, 0, 0}, {0, 1, 0}, {0, 0, 0.45}), 0);
    const auto e = make_enclosure(scene);
    const Point x{0.5, 0.5, 0};
    // The way to the image at (2.7, 0.5, 0.6) is 0.3 m above the floor at x = 1.6.
    CHECK(on_floor(e, x) == Approx(from(bulb, x, true)).epsilon(1e-9));
}

TEST_CASE("The sun and a spot light in a mirror", "[direct]") {
    // A floor, and a mirror that stands on it at x = 1 with its front to the west.
    Scene scene;
    scene.materials = {test::material(0.3), test::mirror(0.9)};
    test::add_surfaces(scene, "floor", mesh::rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 0);
    test::add_surfaces(scene, "mirror", mesh::rectangle({1, 0, 0}, {0, 0, 1}, {0, 1, 0}), 1);
    const Direction down = glm::normalize(Direction(1.0, 0.0, -1.0));
    SECTION("a sun without a diameter") {
        scene.lights = {{"sun", Sun{down, {800.0}, 0.0}}};
        const auto e = make_enclosure(scene);
        const double once = 800.0 * std::sqrt(0.5) / pi;
        // The mirror is one metre high: its light falls on the floor up to one metre before it.
        CHECK(on_floor(e, {0.6, 0.5, 0}) == Approx(1.9 * once).epsilon(1e-9));
        CHECK(on_floor(e, {0.05, 0.5, 0}) == Approx(1.9 * once).epsilon(1e-9));
    }
    SECTION("a sun with one") {
        scene.lights = {{"sun", Sun{down, {800.0}, 0.0093}}};
        const auto e = make_enclosure(scene);
        // Its disc is a polygon straight, and points in the mirror: of the same irradiance to the
        // square of its diameter.
        CHECK(on_floor(e, {0.6, 0.5, 0}) ==
              Approx(1.9 * 800.0 * std::sqrt(0.5) / pi).epsilon(1e-4));
    }
    SECTION("a spot light whose axis meets the mirror") {
        const SpotLight spot{{0.2, 0.5, 0.5}, {1, 0, 0}, {5.0}, 0.6, 0.3};
        scene.lights = {{"spot", spot}};
        const auto e = make_enclosure(scene);
        const Point x{0.4, 0.5, 0}, image{1.8, 0.5, 0.5};
        const Point d = image - x;
        const Direction sent = glm::normalize(Point(-d.x, d.y, -d.z)) * Direction(-1, 1, 1);
        const double share = spot_share(spot, sent);
        REQUIRE(share > 0.0);
        REQUIRE(share < 1.0);
        const double r = glm::length(d);
        const double straight = spot_share(spot, glm::normalize(x - spot.position));
        CHECK(straight == 0.0);
        CHECK(on_floor(e, x) == Approx(0.9 * share * 5.0 * d.z / (pi * r * r * r)).epsilon(1e-6));
    }
}

TEST_CASE("A box without lights or mirrors has no images", "[direct]") {
    Scene scene = lit_box(0.8, true);
    CHECK(!MirroredLights(make_enclosure(scene)).empty());
    CHECK(MirroredLights(make_enclosure(scene, {.mirrors = Mirrors::scattered})).empty());
    scene.lights.clear();
    CHECK(MirroredLights(make_enclosure(scene)).empty());
}
