#include "radiosity/direct_light.h"

#include <tbb/parallel_for.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>

#include "radiosity/closed_forms.h"
#include "support/box_mesh.h"
#include "support/catch.h"
#include "support/gauss.h"

using namespace tyndall;
using mesh::Direction;
using mesh::Opacity;
using mesh::Point;
using radiosity::DirectLight;
using radiosity::Enclosure;
using radiosity::none;
using test::Face;

namespace {

using std::numbers::pi;
enum : std::uint32_t { wall, lamp };

double zone(const DirectLight& light, const Enclosure& e, Point x) {
    double incident = -1.0;
    light.at_zone(x, test::tet_at(e.mesh, x), {&incident, 1});
    return incident;
}

double patch(const DirectLight& light, const Enclosure& e, Point x, Direction n) {
    double incident = -1.0;
    light.at_patch(x, n, test::tet_at(e.mesh, x, n), {&incident, 1});
    return incident;
}

void add_sides(Enclosure& e) {
    e.sides = {{"wall", 0, mesh::Side::front, {0.5}, {0.0}, 0.0},
               {"lamp", 1, mesh::Side::front, {0.0}, {1.0}, 0.0}};
}

void fill(Enclosure& e, double kappa) {
    e.media = {{"haze", {kappa}, {0.5}, {0.0}, {0.5 * kappa}}};
    e.region_medium.assign(e.mesh.region_count, 0);
}

std::vector<double> sorted(std::vector<double> v) {
    std::sort(v.begin(), v.end());
    v.erase(std::unique(v.begin(), v.end()), v.end());
    return v;
}

// An open unit box; `on_face` adds walls to the hull's.
Enclosure open_box(std::array<std::vector<double>, 3> lines, const test::FaceAt& on_face) {
    for (auto& l : lines) {
        l.push_back(0);
        l.push_back(1);
        l = sorted(l);
    }
    return test::box_enclosure(lines, on_face);
}

std::optional<Face> lit_ceiling(Point c, int axis) {
    const bool in_unit = c.x > 0 && c.x < 1 && c.y > 0 && c.y < 1;
    if (axis == 2 && c.z == 1.0 && in_unit) return Face{Opacity::opaque, none, lamp};
    return std::nullopt;
}

}  // namespace

// Figures computed for this project, see docs/validation.
TEST_CASE("Partly hidden parallel squares: exchange areas by integrating H", "[direct_light]") {
    const auto file = nlohmann::json::parse(
        std::ifstream(TYNDALL_SOURCE_DIR "/tests/reference/2_occluded_factors.json"));
    for (const auto& c : file["cases"]) {
        const std::string name = c["name"];
        const bool aperture = name.find("aperture") == 0;
        const auto& s = c["geometry"]["screen"];
        const double x0 = s[0][0], y0 = s[0][1], x1 = s[2][0], y1 = s[2][1], z = s[0][2];
        const auto e0 = [&](Point p, int axis) -> std::optional<Face> {
            const bool inside = p.x > x0 && p.x < x1 && p.y > y0 && p.y < y1;
            if (axis == 2 && p.z == z && inside != aperture)
                return Face{Opacity::opaque, wall, wall};
            return lit_ceiling(p, axis);
        };
        auto e = open_box({{{x0, x1}, {y0, y1}, {z}}}, e0);
        add_sides(e);
        if (c["params"]["kappa"] > 0.0) fill(e, c["params"]["kappa"]);
        const DirectLight light(e);
        // H has kinks where an edge of the screen, seen from x, passes an edge of the ceiling.
        const auto breaks = [&](double a, double b) {
            std::vector<double> at{0, 1};
            for (const double edge : {a, b})
                for (const double top : {0.0, 1.0})
                    if (const double k = (edge - z * top) / (1.0 - z); k > 0.0 && k < 1.0)
                        at.push_back(k);
            return sorted(at);
        };
        const auto bx = breaks(x0, x1), by = breaks(y0, y1);
        double sum = 0.0;
        for (std::size_t i = 0; i + 1 < bx.size(); ++i)
            for (std::size_t j = 0; j + 1 < by.size(); ++j)
                for (const auto& [x, wx] : test::gauss(10, bx[i], bx[i + 1]))
                    for (const auto& [y, wy] : test::gauss(10, by[j], by[j + 1]))
                        sum += wx * wy * patch(light, e, {x, y, 0}, {0, 0, 1});
        INFO(name);
        // Ten Gauss points a smooth piece are exact to 1e-11 in vacuum; in a medium the cubature of
        // τ leaves 1e-5 (aimed at; 1e-4 is needed).
        const double accuracy = c["params"]["kappa"] > 0.0 ? 1.5e-5 : 1e-10;
        CHECK(sum == Approx(static_cast<double>(c["value"])).epsilon(accuracy));
    }
}

TEST_CASE("Sun, point and spot lights: the formulas", "[direct_light]") {
    auto e = open_box({}, lit_ceiling);
    add_sides(e);
    const Direction down = glm::normalize(Direction(0.2, 0.1, -1));
    const Point x{0.3, 0.4, 0.5}, at{0.6, 0.5, 0.9};
    const double r2 = glm::dot(at - x, at - x);
    SECTION("sun through a roof is no sun") {
        e.lights = {{"sun", radiosity::Sun{down, {800.0}, 0.0}, ""}};
        const DirectLight light(e, {.emitters = false});
        CHECK(zone(light, e, x) == 0.0);
    }
    SECTION("sun") {
        e = open_box({}, [](Point, int) { return std::nullopt; });
        fill(e, 0.7);
        e.lights = {{"sun", radiosity::Sun{2.0 * down, {800.0}, 0.0}, ""}};
        const DirectLight light(e);
        const double tau = std::exp(-0.7 * 0.5 / -down.z);
        CHECK(zone(light, e, x) == Approx(800.0 * tau / (4 * pi)).epsilon(1e-13));
        CHECK(patch(light, e, x, {0, 0, 1}) == Approx(800.0 * tau * -down.z / pi).epsilon(1e-13));
        CHECK(patch(light, e, x, {0, 0, -1}) == 0.0);
        // The unit box's top and two sides, as the beam meets them.
        REQUIRE(light.powers().size() == 1);
        CHECK(light.powers()[0].power[0] ==
              Approx(800.0 * (down.x + down.y - down.z)).epsilon(1e-13));
    }
    SECTION("point") {
        fill(e, 0.7);
        e.lights = {{"bulb", radiosity::PointLight{at, {50.0}}, ""}};
        const DirectLight light(e, {.emitters = false});
        const double tau = std::exp(-0.7 * std::sqrt(r2)), cosine = (at.z - x.z) / std::sqrt(r2);
        CHECK(zone(light, e, x) == Approx(50.0 * tau / (4 * pi * r2)).epsilon(1e-13));
        CHECK(patch(light, e, x, {0, 0, 1}) ==
              Approx(50.0 * tau * cosine / (pi * r2)).epsilon(1e-13));
        CHECK(light.powers()[0].power[0] == Approx(4 * pi * 50.0));
    }
    SECTION("spot") {
        const auto spot = [&](double angle, double soft) {
            e.lights = {{"spot", radiosity::SpotLight{at, {0, 0, -1}, {50.0}, angle, soft}, ""}};
            return zone(DirectLight(e, {.emitters = false}), e, x);
        };
        const double full = 50.0 / (4 * pi * r2);
        const double off = std::acos((at.z - x.z) / std::sqrt(r2));  // from the axis
        CHECK(spot(2 * off + 0.01, 0.0) == Approx(full).epsilon(1e-13));
        CHECK(spot(2 * off - 0.01, 0.0) == 0.0);
        CHECK(spot(2 * off - 0.2, 0.2) == Approx(0.5 * full).epsilon(1e-12));  // mid-edge
        CHECK(spot(2 * off - 0.6, 0.2) == 0.0);
        // Power: without a soft edge 2π (1 − cos) I; a soft edge adds to it.
        e.lights = {{"spot", radiosity::SpotLight{at, {0, 0, -1}, {50.0}, 1.0, 0.0}, ""}};
        const double hard = 2 * pi * (1 - std::cos(0.5)) * 50.0;
        CHECK(DirectLight(e, {.emitters = false}).powers()[0].power[0] ==
              Approx(hard).epsilon(1e-12));
    }
}

TEST_CASE("The sun's disc: irradiance, penumbra", "[direct_light]") {
    const double angle = 0.05;
    const auto screen = [](Point c, int axis) -> std::optional<Face> {
        if (axis == 2 && c.z == 0.8 && c.x < 0.5) return Face{Opacity::opaque, wall, wall};
        return std::nullopt;
    };
    auto e = open_box({{{0.5}, {}, {0.8}}}, screen);
    add_sides(e);
    e.lights = {{"sun", radiosity::Sun{{0, 0, -1}, {800.0}, angle}, ""}};
    const DirectLight light(e);
    CHECK(patch(light, e, {0.9, 0.5, 0}, {0, 0, 1}) == Approx(800.0 / pi).epsilon(1e-12));
    // The disc's mean direction is nearer than the beam's: 2 / (1 + cos) times the irradiance,
    // to the polygon's accuracy.
    CHECK(zone(light, e, {0.9, 0.5, 0.1}) ==
          Approx(800.0 / (4 * pi) * 2 / (1 + std::cos(angle / 2))).epsilon(1e-5));
    CHECK(patch(light, e, {0.1, 0.5, 0}, {0, 0, 1}) == 0.0);
    CHECK(patch(light, e, {0.5, 0.5, 0}, {0, 0, 1}) == Approx(400.0 / pi).epsilon(1e-9));
    // A quarter of the radius off: the disc's segment, 0.5 + (u √(1−u²) + asin u) / π with u = 1/4.
    const double u = 0.25, x = 0.5 + u * 0.8 * std::tan(angle / 2);
    const double share = 0.5 + (u * std::sqrt(1 - u * u) + std::asin(u)) / pi;
    CHECK(patch(light, e, {x, 0.5, 0}, {0, 0, 1}) == Approx(800.0 / pi * share).epsilon(2e-3));
}

TEST_CASE("A closed room keeps the sun out; its own walls hide nothing inside", "[direct_light]") {
    const auto room = [](Point c, int axis) -> std::optional<Face> {
        if (c[axis] == 0.0) return Face{Opacity::opaque, wall, none};
        if (c[axis] == 1.0)
            return Face{Opacity::opaque, none, axis == 2 && c.x > 0.5 ? lamp : wall};
        return std::nullopt;
    };
    auto e = open_box({{{0.5}, {}, {}}}, room);
    add_sides(e);
    e.lights = {{"sun", radiosity::Sun{{0.1, 0.2, -1}, {800.0}, 0.01}, ""},
                {"beam", radiosity::Sun{{0.1, 0.2, -1}, {800.0}, 0.0}, ""}};
    const DirectLight light(e);
    const Point x{0.5, 0.5, 0.0};
    const std::vector<Point> seen{{0, -0.5, 1}, {0.5, -0.5, 1}, {0.5, 0.5, 1}, {0, 0.5, 1}};
    CHECK(patch(light, e, x, {0, 0, 1}) ==
          Approx(radiosity::projected_solid_angle(seen, {0, 0, 1}) / pi).epsilon(1e-13));
    CHECK(light.powers()[0].power[0] == Approx(pi * 0.5));
    CHECK(patch(light, e, {0.75, 0.5, 1.0}, {0, 0, -1}) == 0.0);  // in the lamp's own plane
}

TEST_CASE("Very near a lit ceiling, and before it in a thick medium", "[direct_light]") {
    // 60: the part of the ceiling that lights a point is a fiftieth of it.
    const double extinction = GENERATE(3.0, 20.0, 60.0);
    auto e = open_box({}, lit_ceiling);
    add_sides(e);
    fill(e, extinction);
    const DirectLight light(e);
    for (const double gap : {0.2, 0.05, 1e-2, 1e-4, 1e-7}) {
        // An infinite plane in a medium: H = ½ E2(κ gap); the far rim's share is below e^{−1.5}/2…
        // so compare with integration in polar angle over the square, 1e-4 wanted.
        double h = 0.0;
        for (int octant = 0; octant < 8; ++octant)
            for (const auto& [phi, wphi] : test::gauss(16, 0, pi / 4)) {
                const double rim = 0.5 / std::cos(phi);
                const double low = gap / std::hypot(gap, rim);
                // ∫ e^{−κ gap / μ} dμ, in ln μ for small gaps.
                for (int part = 0; part < 8; ++part)
                    for (const auto& [l, wl] :
                         test::gauss(12, std::log(low) * (part + 1) / 8, std::log(low) * part / 8))
                        h += wphi * wl * std::exp(l) * std::exp(-extinction * gap / std::exp(l));
            }
        INFO(extinction << " " << gap);
        CHECK(zone(light, e, {0.5, 0.5, 1 - gap}) == Approx(h / (4 * pi)).epsilon(1e-4));
    }
}

TEST_CASE("Sampled visibility agrees with the exact", "[direct_light]") {
    const auto face = [](Point c, int axis) -> std::optional<Face> {
        if (axis == 2 && c.z == 0.5 && c.x > 0.25 && c.x < 0.5 && c.y > 0.25)
            return Face{Opacity::opaque, wall, wall};
        return lit_ceiling(c, axis);
    };
    auto e = open_box({{{0.25, 0.5}, {0.25}, {0.5}}}, face);
    add_sides(e);
    fill(e, 0.4);
    const DirectLight exact(e), sampled(e, {.exact_occluders = 0, .shadow_rays = 4096});
    double worst = 0.0;
    for (const double x : {0.1, 0.4, 0.7, 0.95})
        for (const double y : {0.05, 0.35, 0.8}) {
            const double a = zone(exact, e, {x, y, 0.1}), b = zone(sampled, e, {x, y, 0.1});
            const double c = patch(exact, e, {x, y, 0}, {0, 0, 1});
            const double d = patch(sampled, e, {x, y, 0}, {0, 0, 1});
            worst = std::max({worst, std::abs(b / a - 1), std::abs(d / c - 1)});
        }
    // 4096 rays of a low-discrepancy sequence on an integrand with a jump: about n^(−3/4) = 0.2 %,
    // three times that for the worst of 24.
    CHECK(worst > 0.0);
    CHECK(worst < 6e-3);
}

TEST_CASE("Parts of direct light add up to it, and are weighed by where they come from",
          "[direct_light]") {
    // A wall with a square hole between the ceiling and the receiver.
    Enclosure e = open_box({{{0.4, 0.7}, {0.3, 0.8}, {0.5}}}, [](Point c, int axis) {
        const bool hole = c.x > 0.4 && c.x < 0.7 && c.y > 0.3 && c.y < 0.8;
        if (axis == 2 && c.z == 0.5 && !hole)
            return std::optional(Face{Opacity::opaque, wall, wall});
        return lit_ceiling(c, axis);
    });
    add_sides(e);
    fill(e, 0.7);
    e.lights = {{"sun", radiosity::Sun{glm::normalize(Direction(0.3, 0.2, -1)), {2.0}, 0.2}},
                {"point", radiosity::PointLight{{0.5, 0.5, 0.7}, {0.1}}}};
    const Point x(0.45, 0.6, 0.2);
    const bool sampled = GENERATE(false, true);
    const DirectLight light(e, {.exact_occluders = sampled ? 0u : 48u, .shadow_rays = 1024});
    const auto weighed = [&](double widest, auto&& weight) {
        double sum = 0.0;
        light.visit_zone(x, test::tet_at(e.mesh, x), widest,
                         [&](Direction towards, std::span<const double> irradiance) {
                             CHECK(glm::length(towards) == Approx(1.0).epsilon(1e-12));
                             sum += irradiance[0] * weight(towards);
                         });
        return sum;
    };
    // Exact but for the transmittance's cubature; sampled shadows have other rays for other parts.
    CHECK(weighed(0.15, [](Direction) { return 1.0; }) ==
          Approx(4.0 * pi * zone(light, e, x)).epsilon(sampled ? 0.02 : 1e-5));
    const auto phase = [](Direction d) {
        return radiosity::phase_value({.asymmetry = 0.7}, glm::dot(d, Direction(0.6, 0, 0.8)));
    };
    // The middle rule's error falls as the square of the width: 0.02's is nothing.
    if (!sampled) CHECK(weighed(0.15, phase) == Approx(weighed(0.02, phase)).epsilon(0.004));
}

TEST_CASE("The same bits on any thread", "[direct_light]") {
    const auto face = [](Point c, int axis) -> std::optional<Face> {
        if (axis == 2 && c.z == 0.5 && c.x > 0.25) return Face{Opacity::opaque, wall, wall};
        return lit_ceiling(c, axis);
    };
    auto e = open_box({{{0.25}, {}, {0.5}}}, face);
    add_sides(e);
    fill(e, 0.4);
    const auto occluders = GENERATE(48, 0);
    const DirectLight light(e, {.exact_occluders = static_cast<std::size_t>(occluders)});
    std::vector<Point> points;
    for (int k = 0; k < 500; ++k) points.push_back({(k % 23 + 0.5) / 23, (k % 19 + 0.5) / 19, 0.2});
    std::vector<double> one(points.size()), many(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) one[k] = zone(light, e, points[k]);
    tbb::parallel_for(std::size_t(0), points.size(),
                      [&](std::size_t k) { many[k] = zone(light, e, points[k]); });
    CHECK(one == many);
}

TEST_CASE("On a wall, an edge or a corner the tet tells the side", "[direct_light]") {
    // A partition at x = 0.5; the lamp in the ceiling shines on its right side only.
    const auto face = [](Point c, int axis) -> std::optional<Face> {
        if (axis == 0 && c.x == 0.5) return Face{Opacity::opaque, wall, wall};
        if (axis == 2 && c.z == 0.0) return Face{Opacity::opaque, wall, none};
        if (axis == 2 && c.z == 1.0 && c.x > 0.5) return Face{Opacity::opaque, none, lamp};
        return std::nullopt;
    };
    auto e = open_box({{{0.5}, {0.5}, {0.5}}}, face);
    add_sides(e);
    const DirectLight light(e);
    for (const Point x : {Point(0.5, 0.4, 0.3), Point(0.5, 0.4, 0.0), Point(0.5, 0.5, 0.5)}) {
        double left, right;
        const Direction side(0.3, 0.01, 0.1);
        light.at_zone(x, test::tet_at(e.mesh, x, side * Direction(-1, 1, 1)), {&left, 1});
        light.at_zone(x, test::tet_at(e.mesh, x, side), {&right, 1});
        CHECK(left < 1e-11);  // the lamp touches the partition's plane
        CHECK(right > 0.03);
        if (x.z > 0.0) continue;
        light.at_patch(x, {0, 0, 1}, test::tet_at(e.mesh, x, side * Direction(-1, 1, 1)),
                       {&left, 1});
        light.at_patch(x, {0, 0, 1}, test::tet_at(e.mesh, x, side), {&right, 1});
        CHECK(left < 1e-11);  // the lamp touches the partition's plane
        CHECK(right > 0.03);
    }
}

TEST_CASE("Direct power check: what a lamp sends out arrives", "[direct_light]") {
    // A closed box, the ceiling lit, nothing in it: π Σ A H = π I A of the lamp.
    const auto room = [](Point c, int axis) -> std::optional<Face> {
        if (c[axis] == 0.0) return Face{Opacity::opaque, wall, none};
        if (c[axis] == 1.0) return Face{Opacity::opaque, none, axis == 2 ? lamp : wall};
        return std::nullopt;
    };
    auto e = open_box({}, room);
    add_sides(e);
    const DirectLight light(e);
    double floor = 0.0, side = 0.0;
    for (const auto& [u, wu] : test::gauss(24, 0, 1))
        for (const auto& [v, wv] : test::gauss(24, 0, 1)) {
            floor += wu * wv * pi * patch(light, e, {u, v, 0}, {0, 0, 1});
            side += wu * wv * pi * patch(light, e, {0, u, v}, {1, 0, 0});
        }
    REQUIRE(light.powers().size() == 1);
    // H jumps to 1/2 at the lamp's rim along a curve that Gauss's 24 points follow to about 1e-4.
    CHECK(floor + 4 * side == Approx(light.powers()[0].power[0]).epsilon(2e-4));
}
