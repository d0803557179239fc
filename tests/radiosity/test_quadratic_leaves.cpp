// Functions on leaves: the ones that fit best, linear and quadratic.
#include <functional>
#include <random>

#include "radiosity/adaptive.h"
#include "radiosity/direct_light.h"
#include "radiosity/incremental_radiosity.h"
#include "radiosity/linear_pieces.h"
#include "radiosity/open_places.h"
#include "radiosity/quadratic.h"
#include "radiosity/segment.h"
#include "support/catch.h"
#include "support/rooms.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

double quadratic(Point x) {
    return 3.0 + x.x - 2.0 * x.y + 0.5 * x.z + 1.5 * x.x * x.x - x.y * x.y + 0.25 * x.z * x.z +
           2.0 * x.x * x.y - x.y * x.z + 0.75 * x.x * x.z;
}

template <std::size_t n>
LeafFunction through(const std::array<Point, n>& corners,
                     const std::function<double(Point)>& function) {
    std::array<double, n> values;
    std::array<double, n*(n - 1) / 2> departures;
    for (std::size_t k = 0; k < n; ++k) values[k] = function(corners[k]);
    std::size_t edge = 0;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j < n; ++j)
            departures[edge++] =
                function(0.5 * (corners[i] + corners[j])) - 0.5 * (values[i] + values[j]);
    return interpolate(corners, values, departures);
}

SolveOptions cheap(Radiance radiance) {
    SolveOptions options;
    options.radiance = radiance;
    options.error = 0.2;
    options.refinement = Refinement::uniform;
    options.element_size = 0.5;
    options.rays = 64;
    options.gather_rays = 64;
    return options;
}

Solution solved(Radiance radiance) {
    return solve_adaptively(std::make_shared<const Enclosure>(make_enclosure(test::slit_room())),
                            cheap(radiance));
}

// Deviation of what zones hold of direct light from what there is, over that, at points spread over
// the medium; and the mean of both.
struct Departure {
    double deviation = 0.0, mean = 0.0;
};
Departure of_direct_light(const Solution& s) {
    const DirectLight light(*s.enclosure);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> u;
    double squares = 0.0, whole = 0.0, held = 0.0, sum = 0.0;
    std::vector<double> incident(1);
    for (int k = 0; k < 4000; ++k) {
        const Point x(3.0 * u(random), 2.0 * u(random), 2.0 * u(random));
        const mesh::TetId tet = mesh::locate(s.enclosure->mesh, x);
        light.at_zone(x, tet, incident);
        const double h = s.direct.at(s.forest.leaf_at(mesh::root_zone(tet), x), 0).at(x);
        squares += std::pow(h - incident[0], 2);
        whole += std::pow(incident[0], 2);
        held += h;
        sum += incident[0];
    }
    return {std::sqrt(squares / whole), held / sum};
}

}  // namespace

TEST_CASE("A quadratic function is found from its values at corners and middles", "[quadratic]") {
    const std::array<Point, 4> tet{
        Point{0.2, 0.1, 0.0}, {1.3, 0.2, 0.1}, {0.4, 0.9, 0.3}, {0.5, 0.4, 1.7}};
    const std::array<Point, 3> triangle{tet[0], tet[1], tet[3]};
    const LeafFunction f = through(tet, quadratic), g = through(triangle, quadratic);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> u;
    double sum = 0.0;
    constexpr int count = 200000;
    for (int k = 0; k < count; ++k) {
        const auto w = uniform_in_tet(u(random), u(random), u(random));
        Point x(0.0);
        for (int c = 0; c < 4; ++c) x += w[c] * tet[c];
        if (k < 50) CHECK(f.at(x) == Approx(quadratic(x)).epsilon(1e-12));
        sum += quadratic(x) / count;
        const auto v = uniform_in_triangle(u(random), u(random));
        const Point y = v[0] * triangle[0] + v[1] * triangle[1] + v[2] * triangle[2];
        if (k < 50) CHECK(g.at(y) == Approx(quadratic(y)).epsilon(1e-12));
    }
    // The linear part has the mean: four standard errors of the sum.
    CHECK(f.Affine::at(0.25 * (tet[0] + tet[1] + tet[2] + tet[3])) == Approx(sum).epsilon(2e-3));
    const Point a = tet[0], b = tet[3];
    CHECK(f.between(a, b) ==
          Approx(quadratic(0.5 * (a + b)) - 0.5 * (quadratic(a) + quadratic(b))).epsilon(1e-12));
    // A flat tet cannot tell: its mean is all there is.
    const std::array<Point, 4> flat{tet[0], tet[1], tet[2], (tet[0] + tet[1] + tet[2]) / 3.0};
    CHECK(through(flat, quadratic).bend.along({1, 1, 1}) == 0.0);
}

TEST_CASE("What the nearest linear function leaves of a tet's eleven values", "[quadratic]") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    std::array<double, 4> corners;
    std::array<double, 6> middles;
    const auto squares = [&](const std::array<double, 4>& f, double centroid) {
        double sum = std::pow(0.25 * (f[0] + f[1] + f[2] + f[3]) - centroid, 2);
        std::size_t edge = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            sum += std::pow(f[i] - corners[i], 2);
            for (std::size_t j = i + 1; j < 4; ++j)
                sum += std::pow(0.5 * (f[i] + f[j]) - middles[edge++], 2);
        }
        return sum;
    };
    for (int trial = 0; trial < 20; ++trial) {
        for (double& v : corners) v = number(random);
        for (double& v : middles) v = number(random);
        const double centroid = number(random), left = squares_left(corners, middles, centroid);
        // Down the slope, exactly along one corner's value after another: the sum is quadratic.
        std::array<double, 4> f{};
        for (int sweep = 0; sweep < 200; ++sweep)
            for (std::size_t i = 0; i < 4; ++i) {
                const auto at = [&](double v) {
                    f[i] = v;
                    return squares(f, centroid);
                };
                const double below = at(-1.0), here = at(0.0), above = at(1.0);
                f[i] = 0.5 * (below - above) / (below - 2.0 * here + above);
            }
        CHECK(left == Approx(squares(f, centroid)).epsilon(1e-9));
        CHECK(left > 0.0);
    }
    // A linear function leaves nothing of itself.
    corners = {1.0, 2.0, -0.5, 0.25};
    middles = {1.5, 0.25, 0.625, 0.75, 1.125, -0.125};
    CHECK(std::abs(squares_left(corners, middles, 0.6875)) < 1e-15);
}

TEST_CASE("What a bend gains along a ray is its integral", "[quadratic]") {
    for (const double tau : {1e-6, 0.01, 0.0999, 0.1001, 1.0, 20.0, 40.0, 600.0}) {
        CAPTURE(tau);
        // Simpson's rule, up to where nothing is left.
        const double end = std::min(tau, 60.0);
        constexpr int steps = 20000;
        double sum = 0.0;
        for (int k = 0; k <= steps; ++k) {
            const double t = end * k / steps, s = t / tau;
            const double weight = k == 0 || k == steps ? 1.0 : k % 2 ? 4.0 : 2.0;
            sum += weight * std::exp(-t) * 4.0 * s * (1.0 - s) * end / steps / 3.0;
        }
        CHECK(bend_weight(segment_weights(tau)) == Approx(sum).epsilon(1e-6));
    }
    CHECK(bend_weight(segment_weights(0.0)) == 0.0);
}

TEST_CASE("Zones hold the function nearest to direct light", "[quadratic]") {
    const Solution constant = solved(Radiance::constant), linear = solved(Radiance::linear),
                   bent = solved(Radiance::quadratic);
    const Departure of_constant = of_direct_light(constant), of_linear = of_direct_light(linear),
                    of_bent = of_direct_light(bent);
    CAPTURE(of_constant.deviation, of_linear.deviation, of_bent.deviation);
    CHECK(of_linear.deviation < 0.8 * of_constant.deviation);
    CHECK(of_bent.deviation < 0.85 * of_linear.deviation);
    for (const Departure& one : {of_constant, of_linear, of_bent})
        CHECK(one.mean == Approx(1.0).epsilon(0.02));
    CHECK(linear.direct.zone_bend.empty());
    CHECK(linear.indirect.patch_bend.empty());
    // No leaves are needed to show what bends.
    CHECK(bent.report.patches <= linear.report.patches);
    CHECK(bent.report.zones == linear.report.zones);
}

TEST_CASE("Linear pieces show a quadratic solution", "[quadratic]") {
    const Solution whole = solved(Radiance::quadratic);
    REQUIRE(is_quadratic(whole));
    constexpr double tolerance = 0.002;
    const Solution pieces = linear_pieces(whole, tolerance, 12);
    CHECK_FALSE(is_quadratic(pieces));
    CHECK(pieces.forest.zone_count() == whole.forest.zone_count());
    CHECK(pieces.forest.patch_count() > whole.forest.patch_count());
    CHECK(pieces.patch_error.size() == pieces.forest.patch_count());
    double mean = 0.0, area = 0.0, worst = 0.0, bend = 0.0;
    for (std::size_t p = 0; p < pieces.forest.patch_count(); ++p) {
        const PatchId piece(p);
        if (!pieces.forest.is_leaf(piece) ||
            side_of(*pieces.enclosure, pieces.forest, piece) == none)
            continue;
        PatchId leaf = piece;
        while (leaf.value >= whole.forest.patch_count() || !whole.forest.is_leaf(leaf))
            leaf = pieces.forest[leaf].parent;
        const Point x = pieces.forest.centroid(piece);
        const double a = scatter_of(whole, leaf, 0), f = whole.indirect.at(leaf, 0).at(x);
        worst = std::max(worst, a * std::abs(f - pieces.indirect.at(piece, 0).at(x)));
        bend = std::max(bend, a * std::abs(f - whole.indirect.at(leaf, 0).Affine::at(x)));
        mean += pieces.forest.area(piece) * a * (f + whole.direct.at(leaf, 0).at(x));
        area += pieces.forest.area(piece);
        CHECK(pieces.direct.at(piece, 0).at(x) == whole.direct.at(leaf, 0).at(x));
    }
    mean /= area;
    CHECK(worst < 1.5 * tolerance * mean);  // at the centroid: up to 4/3 of an edge's middle
    CHECK(bend > 4.0 * worst);

    // Four a patch at most, whatever is asked for.
    const Solution few = linear_pieces(whole, 1e-9);
    CHECK(few.report.patches > whole.report.patches);
    CHECK(few.report.patches <= 4 * whole.report.patches);
}

TEST_CASE("Quadratic solutions add up", "[quadratic][animation]") {
    // Two lamps, on either side of the partition: where one is bright, the other leaves zones dark.
    Scene left = test::slit_room();
    left.materials.push_back(left.materials[1]);
    test::add_surfaces(left, "lamp on the right",
                       mesh::rectangle({2.2, 0.8, 2.0}, {0, 0.4, 0}, {0.4, 0, 0}), 2);
    Scene right = left, both = left;
    left.materials[1].emission = {20.0};
    left.materials[2].emission = {0.0};
    right.materials[1].emission = {0.0};
    right.materials[2].emission = {10.0};
    both.materials[1].emission = {20.0};
    both.materials[2].emission = {10.0};
    const std::vector<Scene> scenes{both, left, right};
    const auto shots = shoot_units(scenes, make_enclosure(both), cheap(Radiance::quadratic));
    REQUIRE(shots.groups.groups.size() == 2);
    const Solution sum = superposed(shots, 0, both), a = superposed(shots, 1, left),
                   b = superposed(shots, 2, right);
    REQUIRE(is_quadratic(sum));
    std::size_t bent = 0;
    for (std::size_t z = 0; z < sum.forest.zone_count(); ++z) {
        const ZoneId zone(z);
        if (!sum.forest.is_leaf(zone)) continue;
        const Point x = sum.forest.point(sum.forest[zone].corners[0]);
        const LeafFunction f = sum.direct.at(zone, 0);
        CHECK(f.at(x) == Approx(a.direct.at(zone, 0).at(x) + b.direct.at(zone, 0).at(x))
                             .epsilon(1e-9)
                             .margin(1e-9));
        bent += f.at(x) != f.Affine::at(x);
    }
    CHECK(bent > 100);
}
