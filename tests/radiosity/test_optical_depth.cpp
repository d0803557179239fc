#include "radiosity/optical_depth.h"

#include <numbers>
#include <random>

#include "radiosity/direct_light.h"
#include "support/box_mesh.h"
#include "support/catch.h"
#include "support/gauss.h"

using namespace tyndall;
using mesh::Direction;
using mesh::Opacity;
using mesh::Point;
using radiosity::none;
using test::Face;

TEST_CASE("Media apart: crossings and walk give one optical depth", "[direct_light]") {
    // Three slabs, the middle one also cut by a box-shaped fog bank.
    const auto face = [](Point c, int axis) -> std::optional<Face> {
        const auto in_bank = [](Point p) {
            return p.x > 0.3 && p.x < 0.6 && p.y > 0.2 && p.y < 0.7 && p.z > 0.4 && p.z < 0.8;
        };
        Point a = c, b = c;
        a[axis] -= 1e-6, b[axis] += 1e-6;
        if (in_bank(a) != in_bank(b) || (axis == 2 && c.z == 0.2))
            return Face{Opacity::interface, none, none};
        return std::nullopt;
    };
    auto e =
        test::box_enclosure({{{0, 0.3, 0.6, 1}, {0, 0.2, 0.7, 1}, {0, 0.2, 0.4, 0.8, 1}}}, face);
    REQUIRE(e.mesh.region_count == 3);
    e.media = {{"thin", {0.3, 1.0}, {0.5}, {0.0}, {0.1}},
               {"thick", {2.0, 5.0}, {0.5}, {0.0}, {0.1}}};
    e.bands = 2;
    const auto region = [&](Point x) {
        return e.mesh.regions[test::tet_at(e.mesh, x).value].value;
    };
    e.region_medium[region({0.1, 0.1, 0.1})] = 0;
    e.region_medium[region({0.4, 0.4, 0.5})] = 1;
    const radiosity::OpticalDepth depth(e, 1e-11);
    std::mt19937_64 rng(5);
    std::uniform_real_distribution<double> u(0, 1);
    for (int k = 0; k < 300; ++k) {
        const Point a(u(rng), u(rng), u(rng)), b(u(rng), u(rng), u(rng));
        const auto tet = test::tet_at(e.mesh, a);
        std::array<double, 2> crossed, exact{};
        depth(a, tet, b - a, crossed);
        const int steps = 1000;  // composite midpoint rule: jumps cost a step each at most
        const double s = glm::distance(a, b), step = s / steps;
        for (int i = 0; i < steps; ++i) {
            const Point p = a + (b - a) * ((i + 0.5) / steps);
            const bool bank =
                p.x > 0.3 && p.x < 0.6 && p.y > 0.2 && p.y < 0.7 && p.z > 0.4 && p.z < 0.8;
            const double kappa[]{bank        ? 2.0
                                 : p.z < 0.2 ? 0.3
                                             : 0.0,
                                 bank        ? 5.0
                                 : p.z < 0.2 ? 1.0
                                             : 0.0};
            for (int band = 0; band < 2; ++band) exact[band] += step * kappa[band];
        }
        CHECK(std::abs(crossed[0] - exact[0]) <= 2.0 * 2 * step);
        CHECK(std::abs(crossed[1] - exact[1]) <= 5.0 * 2 * step);
        std::array<double, 2> walked;
        depth.walked(a, tet, b - a, walked);
        CHECK(walked[0] == Approx(crossed[0]).margin(1e-13));
        CHECK(walked[1] == Approx(crossed[1]).margin(1e-13));
    }
}

TEST_CASE("Media apart, one of which varies: crossings and walk give one optical depth",
          "[direct_light]") {
    // Fog that thins with height below z = 0.5, a uniform bank above it, and nothing beyond x =
    // 0.6.
    const auto face = [](Point c, int axis) -> std::optional<Face> {
        if ((axis == 2 && c.z == 0.5 && c.x < 0.6) || (axis == 0 && c.x == 0.6))
            return Face{Opacity::interface, none, none};
        return std::nullopt;
    };
    auto e = test::box_enclosure({{{0, 0.6, 1}, {0, 1}, {0, 0.5, 1}}}, face);
    REQUIRE(e.mesh.region_count == 3);
    const auto kappa = [](Point p) { return 2.0 - 3.0 * p.z + p.x * p.y; };
    e.media = {{"fog", {1.0}, {0.5}, {0.0}, {0.5}}, {"bank", {0.7}, {0.5}, {0.0}, {0.35}}};
    e.media[0].varying = {{radiosity::sample_function(kappa, {0, 0, 0}, {0.6, 1, 0.5}).grid, 1.0}};
    const auto region = [&](Point x) {
        return e.mesh.regions[test::tet_at(e.mesh, x).value].value;
    };
    e.region_medium[region({0.1, 0.1, 0.1})] = 0;
    e.region_medium[region({0.1, 0.1, 0.9})] = 1;
    const radiosity::OpticalDepth depth(e, 1e-11);
    std::mt19937_64 rng(6);
    std::uniform_real_distribution<double> u(0, 1);
    for (int k = 0; k < 200; ++k) {
        const Point a(u(rng), u(rng), u(rng)), b(u(rng), u(rng), u(rng));
        const auto tet = test::tet_at(e.mesh, a);
        const int steps = 1000;  // composite midpoint rule: jumps cost a step each at most
        const double s = glm::distance(a, b), step = s / steps;
        double crossed, walked, sum = 0.0;
        for (int i = 0; i < steps; ++i) {
            const Point p = a + (b - a) * ((i + 0.5) / steps);
            sum += step * (p.x > 0.6 ? 0.0 : p.z > 0.5 ? 0.7 : kappa(p));
        }
        depth(a, tet, b - a, {&crossed, 1});
        depth.walked(a, tet, b - a, {&walked, 1});
        CHECK(std::abs(crossed - sum) <= 2.0 * 3 * step);
        CHECK(walked == Approx(crossed).margin(1e-12));
    }
}

TEST_CASE("A layered medium: τ within the integral", "[direct_light]") {
    // Fog above z = 0.5 under a lit ceiling: against brute-force integration.
    const auto face = [](Point c, int axis) -> std::optional<Face> {
        if (axis == 2 && c.z == 0.5) return Face{Opacity::interface, none, none};
        if (axis == 2 && c.z == 1.0) return Face{Opacity::opaque, none, 0};
        return std::nullopt;
    };
    auto e = test::box_enclosure({{{0, 1}, {0, 1}, {0, 0.5, 1}}}, face);
    e.sides = {{"lamp", 0, mesh::Side::front, {0.0}, {1.0}, 1.0}};
    const double kappa = GENERATE(0.1, 1.0, 5.0);
    e.media = {{"fog", {kappa}, {0.5}, {0.0}, {0.5 * kappa}}};
    e.region_medium[e.mesh.regions[test::tet_at(e.mesh, {0.5, 0.5, 0.9}).value].value] = 0;
    const radiosity::DirectLight light(e);
    const Point x{0.3, 0.6, 0.2};
    double h = 0.0, irradiance = 0.0;
    for (const auto& [u, wu] : test::gauss(40, 0, 1))
        for (const auto& [v, wv] : test::gauss(40, 0, 1)) {
            const Direction p = Point(u, v, 1) - x;
            const double s = glm::length(p);
            const double w = wu * wv * std::exp(-kappa * s * 0.5 / 0.8) * 0.8 / (s * s * s);
            h += w / (4 * std::numbers::pi);
            irradiance += w * 0.8 / s / std::numbers::pi;
        }
    // 1e-4 is needed, 1e-5 aimed at.
    const auto tet = test::tet_at(e.mesh, x);
    double incident;
    light.at_zone(x, tet, {&incident, 1});
    CHECK(incident == Approx(h).epsilon(1e-5));
    light.at_patch(x, {0, 0, 1}, tet, {&incident, 1});
    CHECK(incident == Approx(irradiance).epsilon(1e-5));
}
