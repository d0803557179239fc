// The room that path tracers get: what bounds each medium is closed and looks the right way.
#include "exports/path_room.h"

#include <numeric>

#include "exports/sun_disc.h"
#include "rich_room.h"
#include "support/catch.h"

using namespace tyndall;

namespace {

// ∫ x · n dA / 3 of a sheet, and its area.
struct Measure {
    double volume = 0.0, area = 0.0;
};

Measure measure(const exports::Triangles& triangles) {
    Measure result;
    for (const auto& corners : triangles.corners) {
        std::array<mesh::Point, 3> p;
        for (int k = 0; k < 3; ++k) p[k] = triangles.points[corners[k]];
        const auto twice = glm::cross(p[1] - p[0], p[2] - p[0]);
        result.volume += glm::dot(p[0], twice) / 6.0;
        result.area += glm::length(twice) / 2.0;
    }
    return result;
}

// Of a medium, by Gauss' theorem over all that it ends at.
double enclosed_volume(const exports::PathRoom& room, std::uint32_t medium) {
    double volume = 0.0;
    for (const auto* sheets : {&room.walls, &room.boundaries})
        for (const auto& sheet : *sheets) {
            const double part = measure(sheet.triangles).volume;
            if (sheet.medium_front == medium) volume -= part;  // the normal looks into it
            if (sheet.medium_back == medium) volume += part;
        }
    return volume;
}

double volume_of(const radiosity::Enclosure& e, std::uint32_t medium) {
    double volume = 0.0;
    for (std::size_t t = 0; t < e.mesh.tets.size(); ++t)
        if (e.medium_of(mesh::TetId(t)) == medium) volume += mesh::volume(e.mesh, mesh::TetId(t));
    return volume;
}

const exports::Sheet& wall_named(const exports::PathRoom& room, const std::string& name) {
    for (const auto& wall : room.walls)
        if (wall.name == name) return wall;
    throw std::runtime_error("no wall " + name);
}

}  // namespace

TEST_CASE("Walls and boundaries enclose every medium", "[export]") {
    auto scene = test::rich_room();
    // Once in closed walls, once with a window and fog up to the hull.
    const bool open = GENERATE(false, true);
    if (open) {
        scene = test::open_floor(0.5);
        scene.media = {test::medium(0.2, 0.5)};
    }
    const auto enclosure = test::enclosed(scene);
    const auto room = exports::path_room(*enclosure);
    REQUIRE(room.media.size() == scene.media.size());
    for (std::uint32_t m = 0; m < room.media.size(); ++m) {
        const double volume = volume_of(*enclosure, m);
        REQUIRE(volume > 0.0);
        // Rounding; the screen's two sheets stand 8e-5 m apart, the fog lost between them counts
        // its 1 m² times that.
        CHECK(enclosed_volume(room, m) == Approx(volume).epsilon(1e-4));
    }
    CHECK(room.boundaries.size() == (open ? 1 : 1));
}

TEST_CASE("Every side that light reaches is in the room with its area", "[export]") {
    const auto enclosure = test::enclosed(test::rich_room());
    const bool one_material = GENERATE(false, true);
    const auto room = exports::path_room(*enclosure, {.one_material = one_material});
    double sides = 0.0, found = 0.0;
    for (const auto& side : enclosure->sides) sides += side.area;
    for (const auto& wall : room.walls)
        found += measure(wall.triangles).area * (wall.back ? 2.0 : 1.0);
    CHECK(found == Approx(sides).epsilon(1e-9));
    for (const auto& wall : room.walls) {
        if (wall.back) CHECK_FALSE(wall.back->emits());
        if (one_material && wall.back) CHECK(*wall.back == wall.front);
    }
}

TEST_CASE("A screen that glows on both sides is two sheets that look away from each other",
          "[export]") {
    const auto enclosure = test::enclosed(test::rich_room());
    const auto room = exports::path_room(*enclosure);
    std::vector<const exports::Sheet*> screens;
    for (const auto& wall : room.walls)
        if (wall.name == "screen") screens.push_back(&wall);
    REQUIRE(screens.size() == 2);
    double towards = 0.0;
    for (const auto* screen : screens) {
        CHECK(screen->front.emission == exports::Spectrum{2.0});
        CHECK(screen->front.diffuse == exports::Spectrum{0.3});
        CHECK_FALSE(screen->back);
        const auto& [points, corners] = screen->triangles;
        const auto n = glm::normalize(glm::cross(points[corners[0][1]] - points[corners[0][0]],
                                                 points[corners[0][2]] - points[corners[0][0]]));
        CHECK(std::abs(n.x) == Approx(1.0));
        // Moved to the side that it looks to, by a hundred-thousandth of the room.
        CHECK((points[0].x - 1.5) * n.x == Approx(1e-5 * room.size).epsilon(1e-6));
        towards += n.x;
    }
    CHECK(towards == Approx(0.0).margin(1e-12));
}

TEST_CASE("Media and finishes have the scene's own numbers", "[export]") {
    const auto room = exports::path_room(*test::enclosed(test::rich_room()));
    // Not (1 − 0.7) of the scattering, as the solve has it.
    CHECK(room.media[0].extinction[0] == Approx(0.4));
    CHECK(room.media[0].albedo[0] == Approx(0.8));
    CHECK(room.media[0].phase.asymmetry == 0.7);
    const auto& gloss = wall_named(room, "room.y0").front;
    CHECK(gloss.diffuse[0] == Approx(0.2));
    CHECK(gloss.specular[0] == Approx(0.4));
    CHECK(gloss.roughness == 0.3);
    const double share = exports::specular_share(gloss, "gloss");
    CHECK((gloss.specular[0] / share <= 1.0 && gloss.diffuse[0] / (1.0 - share) <= 1.0));
    // A lobe of roughness 0.3 loses some 3 % of its light (0.027 at 60°, by Mitsuba's sampling).
    const auto kept = exports::with_lost_light(gloss);
    CHECK(kept.diffuse[0] - gloss.diffuse[0] == Approx(0.4 * 0.028).epsilon(0.25));
    CHECK(exports::with_lost_light({{0.6}, {0.4}, 1.0, {0.0}}).diffuse[0] == Approx(0.6));
    CHECK(wall_named(room, "room.floor").front.diffuse[0] == 0.6);
    CHECK(room.environment == exports::Spectrum{0.25});
    CHECK(exports::medium_at(*test::enclosed(test::rich_room()), {0.6, 0.6, 0.6}) == 1);
}

TEST_CASE("One band of many is a grey room", "[export]") {
    auto scene = test::slit_room();
    scene.bands = 4;
    for (auto& m : scene.materials) {
        if (!m.emission.empty()) m.emission = {1, 2, 3, 4};
        m.reflectance = {0.1, 0.2, 0.3, 0.4};
    }
    scene.media[0].extinction = {0.1, 0.2, 0.3, 0.4};
    scene.media[0].albedo = {0.5, 0.6, 0.7, 0.8};
    const auto enclosure = test::enclosed(scene);
    const auto room = exports::path_room(*enclosure, {.band = 2});
    CHECK(room.bands == 1);
    CHECK(room.media[0].extinction[0] == Approx(0.3));
    CHECK(room.media[0].albedo[0] == Approx(0.7));
    CHECK(wall_named(room, "room.floor").front.diffuse == exports::Spectrum{0.3});
    CHECK(wall_named(room, "lamp").front.emission == exports::Spectrum{3.0});
    CHECK_THROWS_WITH(exports::path_room(*enclosure), Contains("has 4 bands"));
    CHECK_THROWS_WITH(exports::path_room(*enclosure, {.band = 4}), Contains("bands 0 to 3"));
}

TEST_CASE("A path tracer is not told what it cannot know", "[export]") {
    auto scene = test::slit_room();
    SECTION("a sink") {
        scene.materials[0].flux = {-1.0};
        CHECK_THROWS_WITH(exports::path_room(*test::enclosed(scene)), Contains("flux"));
    }
    SECTION("a heated medium") {
        scene.media[0].heat = {5.0};
        CHECK_THROWS_WITH(exports::path_room(*test::enclosed(scene)), Contains("heated"));
    }
    SECTION("equilibrium is scattering without loss") {
        scene.media[0].heat = {0.0};
        CHECK(exports::path_room(*test::enclosed(scene)).media[0].albedo[0] == 1.0);
    }
    SECTION("more gloss in one band than the reflectance of another leaves") {
        const exports::Finish finish{{0.9, 0.0, 0.0}, {0.0, 0.9, 0.0}, 0.0, {}};
        CHECK_THROWS_WITH(exports::specular_share(finish, "wall"), Contains("add up to 1.8"));
    }
}

TEST_CASE("The sun's disc has the sun's angle and irradiance", "[export]") {
    const radiosity::Sun sun{{0.3, -0.4, -1.2}, {800.0}, 0.02};
    const auto disc = exports::sun_disc(sun, {1, 2, 3}, 7.0);
    const double distance = glm::distance(disc.centre, mesh::Point(1, 2, 3));
    CHECK(distance == Approx(7e4));
    CHECK(2.0 * std::atan(disc.radius / distance) == Approx(0.02));
    // Of a disc seen face on: E = π L R² / (R² + d²).
    const double r = disc.radius;
    CHECK(std::numbers::pi * disc.radiance[0] * r * r / (r * r + distance * distance) ==
          Approx(800.0));
    CHECK(glm::dot(disc.up, sun.direction) == Approx(0.0).margin(1e-12));
}

TEST_CASE("Names are plain and differ", "[export]") {
    using Names = std::vector<std::string>;
    CHECK(exports::plain_names({"room.floor", "room floor", "room_floor", "ab"}) ==
          Names{"room_floor", "room_floor_2", "room_floor_3", "ab"});
}
