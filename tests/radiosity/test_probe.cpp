// Probes in enclosures whose answer is known.
#include <cmath>
#include <numbers>

#include "mesh/input_error.h"
#include "radiosity/adaptive.h"
#include "radiosity/planck_fraction.h"
#include "radiosity/probe.h"
#include "support/box_mesh.h"
#include "support/catch.h"

namespace {

using namespace tyndall;
using namespace tyndall::radiosity;
using std::numbers::pi;

// A box of 1 m whose walls emit 2 W/m^2/sr, filled with a medium in equilibrium with them: radiance
// is 2 everywhere and in every direction.
std::shared_ptr<const Enclosure> furnace(bool foggy) {
    const std::vector<double> lines{0.0, 0.5, 1.0};
    auto e = test::box_enclosure({lines, lines, lines}, [](mesh::Point c, int axis) {
        if (c[axis] == 0.0) return std::optional(test::Face{mesh::Opacity::opaque, 0, none});
        if (c[axis] == 1.0) return std::optional(test::Face{mesh::Opacity::opaque, none, 0});
        return std::optional<test::Face>();
    });
    e.sides = {{"walls+", 0, mesh::Side::front, {0.5}, {1.0}, 6.0}};
    if (foggy) {
        e.media = {{"fog", {0.8}, {0.75}, {0.5}, {0.2}}};
        e.region_medium.assign(e.region_medium.size(), 0);
    }
    return std::make_shared<const Enclosure>(std::move(e));
}

Solution solve(std::shared_ptr<const Enclosure> enclosure, DirectLightMode mode) {
    SolveOptions options;
    options.refinement = Refinement::none;
    options.direct_light = mode;
    options.rays = 256;
    options.gather_rays = 256;
    return solve_adaptively(std::move(enclosure), options);
}

}  // namespace

TEST_CASE("in a furnace every probe sees the same radiance") {
    const bool foggy = GENERATE(false, true);
    const auto mode = GENERATE(DirectLightMode::closed_form, DirectLightMode::rows);
    CAPTURE(foggy, int(mode));
    const Solution solution = solve(furnace(foggy), mode);
    const Probe probe(solution, {1024, 1});
    // The elements' own error: rows and gathers of 256 rays, constant elements on the first mesh.
    const auto near = [](double value) { return Approx(value).epsilon(0.02); };
    for (const mesh::Point x :
         {mesh::Point{0.5, 0.5, 0.5}, {0.1, 0.2, 0.9}, {0, 0, 0}, {1, 1, 0.3}}) {
        CAPTURE(x.x, x.y, x.z);
        const auto values = probe.in_space(x);
        CHECK(values.incident[0] == near(8.0 * pi));
        CHECK(values.source[0] == (foggy ? near(2.0) : Approx(0.0)));
        if (mode == DirectLightMode::rows) CHECK(values.incident_direct[0] == 0.0);
    }
    for (const mesh::Direction n : {mesh::Direction{0, 0, 1}, {0, 3, 0}, {1, 1, 1}}) {
        CHECK(probe.on_surface({0, 0, 0}, n).irradiance[0] == near(2.0 * pi));
        CHECK(probe.on_surface({0.5, 0.5, 0.5}, n).irradiance[0] == near(2.0 * pi));
    }
    CHECK(probe.on_surface({1, 0.2, 1}, {-1, 0, 0}).irradiance[0] == near(2.0 * pi));
}

TEST_CASE("probes need a place in the open and a normal") {
    const Solution solution = solve(furnace(false), DirectLightMode::closed_form);
    const Probe probe(solution, {16, 1});
    CHECK_THROWS_WITH(probe.in_space({2, 0, 0}), Contains("[2, 0, 0]") && Contains("outside"));
    CHECK_THROWS_WITH(probe.on_surface({1, 0.5, 0.5}, {1, 0, 0}), Contains("outside"));
    CHECK_THROWS_WITH(probe.on_surface({0.5, 0.5, 0.5}, {0, 0, 0}), Contains("no direction"));
}

TEST_CASE("probes find temperatures on walls and in media, where a scene has them") {
    // The floor is kept at what arrives (a = 1, no flux), the other walls and the medium at what
    // they are given; in equilibrium all have the temperature of σT⁴/π = 2.
    const auto settled = [](bool thermal) {
        Enclosure e = *furnace(true);
        e.thermal = thermal;
        e.sides.push_back({"floor+", 1, mesh::Side::front, {1.0}, {0.0}, 1.0, {0.5}});
        for (std::size_t f = 0; f < e.mesh.facets.size(); ++f)
            if (e.facet_sides[f][0] == 0 && std::abs(mesh::normal(e.mesh, FacetId(f)).z) > 0.5)
                e.facet_sides[f][0] = 1;
        return solve(std::make_shared<const Enclosure>(std::move(e)), DirectLightMode::closed_form);
    };
    const Solution solution = settled(true);
    const Probe probe(solution, {1024, 1});
    const double expected = std::pow(2.0 * pi / stefan_boltzmann, 0.25);
    // H is good to 2 %, and T is the fourth root of it; what is given is as it was given.
    CHECK(probe.on_surface({0.3, 0.4, 0}, {0, 0, 1}).temperature ==
          Approx(expected).epsilon(0.005));
    CHECK(probe.on_surface({1, 0.4, 0.3}, {-1, 0, 0}).temperature ==
          Approx(expected).epsilon(1e-9));
    CHECK(probe.in_space({0.3, 0.4, 0.6}).temperature == Approx(expected).epsilon(1e-9));
    // No wall, and none whose side the normal looks from.
    CHECK(std::isnan(probe.on_surface({0.3, 0.4, 0.6}, {0, 0, 1}).temperature));
    CHECK(std::isnan(probe.on_surface({0.3, 0.4, 0}, {1, 0, 0}).temperature));
    const Solution cold = settled(false);
    CHECK(std::isnan(Probe(cold, {16, 1}).in_space({0.3, 0.4, 0.6}).temperature));
    CHECK(std::isnan(Probe(cold, {16, 1}).on_surface({1, 0.4, 0.3}, {-1, 0, 0}).temperature));
}
