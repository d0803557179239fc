// Scenes that differ in emissions: as sums of unit solutions, and solved in full.
#include "radiosity/incremental_radiosity.h"

#include <cmath>

#include "radiosity/enclosure_emissions.h"
#include "support/catch.h"
#include "support/rooms.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

// A foggy room with a lamp in the ceiling, a glowing patch of wall, and glowing fog; two bands.
Scene room(Spectrum lamp, Spectrum glow, Spectrum fog) {
    Scene scene;
    scene.bands = 2;
    scene.materials = {test::material(0.5), test::material(0.0), test::material(0.2)};
    for (auto& m : scene.materials) m.reflectance.push_back(0.8 * m.reflectance[0]);
    scene.materials[1].name = "lamp";
    scene.materials[1].power = lamp;
    scene.materials[2].name = "glow";
    scene.materials[2].emission = glow;
    test::add_surfaces(scene, "room", mesh::room({0, 0, 0}, {2, 1, 1}), 0);
    test::add_surfaces(scene, "shelf", mesh::rectangle({0.9, 0, 0}, {0, 1, 0}, {0, 0, 0.6}), 0);
    test::add_surfaces(scene, "lamp", mesh::rectangle({0.3, 0.3, 1}, {0, 0.4, 0}, {0.4, 0, 0}), 1);
    test::add_surfaces(scene, "glow", mesh::rectangle({2, 0.3, 0.3}, {0, 0, 0.4}, {0, 0.4, 0}), 2);
    scene.media = {test::medium(0.4, 0.7)};
    scene.media[0].extinction.push_back(0.4);
    scene.media[0].albedo.push_back(0.9);
    scene.media[0].emission = fog;
    return scene;
}

SolveOptions cheap_shots() {
    SolveOptions options;
    options.error = 0.2;
    options.rays = 32;
    options.gather_rays = 32;
    options.element_size = 0.6;
    options.max_elements = 20000;
    return options;
}

// Relative root mean square difference of H's means over the media and sides of two solutions of
// one mesh, weighed by what elements take up.
double difference(const Solution& a, const Solution& b) {
    const Elements& e = a.coarse.elements;
    REQUIRE(b.coarse.elements.size() == e.size());
    double error = 0.0, whole = 0.0;
    for (std::size_t k = 0; k < a.coarse.radiance.size(); ++k) {
        error += e.capacity[k] * std::pow(a.coarse.incident[k] - b.coarse.incident[k], 2);
        whole += e.capacity[k] * std::pow(b.coarse.incident[k], 2);
    }
    return std::sqrt(error / whole);
}

}  // namespace

TEST_CASE("Sources that keep step are one group, dark ones none", "[animation]") {
    const std::vector<Scene> scenes = {room({1, 2}, {2, 4}, {0, 0}), room({2, 4}, {4, 8}, {0, 0}),
                                       room({0, 0}, {0, 0}, {0, 0})};
    const auto together = group_sources(scenes);
    REQUIRE(together.groups.size() == 1);
    CHECK(together.groups[0].sources ==
          std::vector<std::string>{"material \"lamp\"", "material \"glow\""});
    CHECK(together.groups[0].weights == std::vector<Spectrum>{{0.5, 0.5}, {1.0, 1.0}, {0.0, 0.0}});
    CHECK(together.largest.materials[1].power == Spectrum{2, 4});

    const std::vector<Scene> apart = {room({1, 2}, {3, 3}, {1, 0}), room({2, 1}, {3, 3}, {1, 0})};
    const auto groups = group_sources(apart).groups;
    REQUIRE(groups.size() == 2);
    CHECK(groups[0].scene.materials[1].power == Spectrum{2, 2});
    CHECK(groups[0].scene.materials[2].emission == Spectrum{0, 0});
    CHECK(groups[0].weights == std::vector<Spectrum>{{0.5, 1.0}, {1.0, 0.5}});
    // What stays the same is together.
    CHECK(groups[1].sources == std::vector<std::string>{"material \"glow\"", "medium \"haze\""});
    CHECK(groups[1].weights == std::vector<Spectrum>{{1, 1}, {1, 1}});
    CHECK(groups[1].scene.media[0].emission == Spectrum{1, 0});
}

TEST_CASE("Emissions bound anew are those of an enclosure made anew", "[animation]") {
    const Scene before = room({1, 2}, {3, 3}, {1, 0}), after = room({5, 0}, {1, 2}, {0, 7});
    Enclosure bound = make_enclosure(before);
    const Enclosure made = make_enclosure(after);
    bind_emissions(after, bound);
    REQUIRE(bound.sides.size() == made.sides.size());
    for (std::size_t k = 0; k < made.sides.size(); ++k)
        CHECK(bound.sides[k].emission == made.sides[k].emission);
    CHECK(bound.media[0].emission == made.media[0].emission);
}

TEST_CASE("A sum of unit solutions is the full solve", "[animation][long]") {
    std::vector<Scene> scenes = {room({9, 9}, {1, 2}, {0.1, 0.1}), room({3, 6}, {4, 1}, {0.1, 0.1}),
                                 room({0, 0}, {4, 4}, {0.1, 0.1})};
    const Enclosure enclosure = make_enclosure(scenes[0]);
    const auto shots = shoot_units(scenes, enclosure, cheap_shots());
    REQUIRE(shots.units.size() == 3);
    const Solution sum = superposed(shots, 1, scenes[1]);

    // On the mesh of the units the full solve differs from the sum by what is not linear: factors
    // that make what patches reflect of direct light hold its power are each source's own, and
    // other leaves get their mean from more points. The bound is a fortieth of the error goal.
    Passes frozen;
    frozen.begin_with =
        std::make_shared<const KeptMesh>(KeptMesh{enclosure.mesh, shots.units[0].forest});
    frozen.frozen = true;
    const Solution full =
        solve_adaptively(std::make_shared<const Enclosure>(make_enclosure(scenes[1])),
                         cheap_shots(), {}, {}, frozen);
    CHECK(difference(sum, full) < 5e-3);
    CHECK(difference(superposed(shots, 0, scenes[0]), full) > 0.1);

    for (const auto& [name, power] : full.report.net_power)
        for (std::size_t b = 0; b < 2; ++b) {
            INFO(name << " band " << b);
            CHECK(sum.report.net_power.at(name)[b] == Approx(power[b]).margin(0.02));  // of 9 W
        }
    // A bound of the full solve's own: the units' errors added up as if they had one sign.
    CHECK(sum.report.estimated_error > 0.9 * full.report.estimated_error);
    CHECK(sum.report.estimated_error < 2.0 * full.report.estimated_error);
    CHECK(shots.solves <= 8);  // the mesh and three groups, at most once more
    for (std::size_t b = 0; b < 2; ++b) {
        const auto& side = sum.enclosure->sides[0];
        CHECK(side.emission[b] == full.enclosure->sides[0].emission[b]);
    }
}

TEST_CASE("One group is the mesh's own solve, nothing that shines is dark", "[animation]") {
    const std::vector<Scene> scenes = {room({4, 4}, {0, 0}, {0, 0}), room({1, 1}, {0, 0}, {0, 0})};
    const Enclosure enclosure = make_enclosure(scenes[0]);
    const auto shots = shoot_units(scenes, enclosure, cheap_shots());
    CHECK(shots.solves == 1);
    const Solution whole = superposed(shots, 0, scenes[0]),
                   quarter = superposed(shots, 1, scenes[1]);
    for (std::size_t k = 0; k < whole.coarse.radiance.size(); ++k)
        CHECK(quarter.coarse.radiance[k] == Approx(0.25 * whole.coarse.radiance[k]));
    CHECK(quarter.report.estimated_error == Approx(whole.report.estimated_error));

    const std::vector<Scene> dark = {room({0, 0}, {0, 0}, {0, 0})};
    const auto none = shoot_units(dark, make_enclosure(dark[0]), cheap_shots());
    for (const double x : superposed(none, 0, dark[0]).coarse.radiance) CHECK(x == 0.0);
}
