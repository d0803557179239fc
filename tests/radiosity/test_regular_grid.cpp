#include "radiosity/regular_grid.h"

#include <glm/geometric.hpp>
#include <random>

#include "mesh/input_error.h"
#include "support/catch.h"
#include "support/gauss.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

// f at the points of a grid over the box.
template <class F>
RegularGrid grid_of(std::array<std::size_t, 3> n, Point low, Point high, F f,
                    BeyondGrid beyond = BeyondGrid::nothing) {
    std::vector<float> values;
    for (std::size_t k = 0; k < n[2]; ++k)
        for (std::size_t j = 0; j < n[1]; ++j)
            for (std::size_t i = 0; i < n[0]; ++i)
                values.push_back(static_cast<float>(
                    f(low + (high - low) * Direction(double(i) / double(n[0] - 1),
                                                     double(j) / double(n[1] - 1),
                                                     double(k) / double(n[2] - 1)))));
    return {n, low, high, std::move(values), beyond};
}

Point point_in(std::mt19937_64& rng, Point low, Point high) {
    std::uniform_real_distribution<double> u(0, 1);
    return low + (high - low) * Direction(u(rng), u(rng), u(rng));
}

}  // namespace

TEST_CASE("Regular grid: a trilinear function is kept, and integrated along any line") {
    // Values are kept in single precision: 1e-7 of them.
    const auto f = [](Point p) { return 1.0 + 0.5 * p.x + 0.25 * p.y * p.z + p.x * p.y * p.z; };
    const Point low(0, 1, 2), high(2, 2, 5);
    const auto grid = grid_of({4, 3, 6}, low, high, f);
    std::mt19937_64 rng(1);
    for (int k = 0; k < 200; ++k) {
        const Point a = point_in(rng, low, high), b = point_in(rng, low, high);
        CHECK(grid.at(a) == Approx(f(a)).epsilon(1e-6));
        const double s = glm::distance(a, b);
        // A cubic along the line: two points of Gauss's rule are exact.
        double exact = 0.0;
        for (const double t : {0.5 - 0.5 / std::sqrt(3.0), 0.5 + 0.5 / std::sqrt(3.0)})
            exact += 0.5 * s * f(a + t * (b - a));
        CHECK(grid.integral(a, (b - a) / s, 0.0, s) == Approx(exact).epsilon(1e-6));
    }
}

TEST_CASE("Regular grid: integrals of any values are those of fine sums, and add up") {
    std::mt19937_64 rng(2);
    std::uniform_real_distribution<double> u(0, 1);
    const Point low(-1, -1, -1), high(1, 1, 1);
    const auto grid = grid_of({7, 5, 9}, low, high, [&](Point) { return u(rng); });
    for (int k = 0; k < 100; ++k) {
        // Also from outside, to outside, and past the box.
        const Point a = point_in(rng, 1.5 * low, 1.5 * high);
        const Point b = point_in(rng, 1.5 * low, 1.5 * high);
        const double s = glm::distance(a, b);
        const Direction d = (b - a) / s;
        double sum = 0.0;
        const int steps = 20000;
        for (int i = 0; i < steps; ++i) sum += s / steps * grid.at(a + d * (s * (i + 0.5) / steps));
        // The sum's steps at the box's faces and kinks.
        CHECK(grid.integral(a, d, 0.0, s) == Approx(sum).margin(3e-4 * s));
        const double middle = s * u(rng);
        CHECK(grid.integral(a, d, 0.0, middle) + grid.integral(a, d, middle, s) ==
              Approx(grid.integral(a, d, 0.0, s)).margin(1e-13));
        CHECK(grid.integral(b, -d, 0.0, s) == Approx(grid.integral(a, d, 0.0, s)).margin(1e-13));
    }
}

TEST_CASE("Regular grid: lines in its planes and along its edges; what lies beyond") {
    const auto f = [](Point p) { return p.x; };
    const auto nothing = grid_of({3, 3, 3}, {0, 0, 0}, {1, 1, 1}, f);
    const auto edge = grid_of({3, 3, 3}, {0, 0, 0}, {1, 1, 1}, f, BeyondGrid::edge);
    // Exactly: halves and their sums are numbers of the machine.
    for (const double y : {0.0, 0.5, 1.0})
        for (const double z : {0.0, 0.5, 1.0}) {
            CHECK(nothing.integral({0, y, z}, {1, 0, 0}, 0.0, 1.0) == 0.5);
            CHECK(nothing.integral({1, y, z}, {-1, 0, 0}, 0.0, 1.0) == 0.5);
        }
    CHECK(nothing.integral({-1, 0.5, 0.5}, {1, 0, 0}, 0.0, 3.0) == 0.5);
    CHECK(nothing.integral({0.5, 2, 0.5}, {1, 0, 0}, -9.0, 9.0) == 0.0);
    CHECK(nothing.at({1.001, 0.5, 0.5}) == 0.0);
    CHECK(edge.at({1.5, 0.5, 0.5}) == 1.0);
    CHECK(edge.integral({-1, 0.5, 0.5}, {1, 0, 0}, 0.0, 3.0) == 1.5);
    CHECK(edge.integral({2, -3, 0.5}, {-1, 0, 0}, 0.0, 3.0) == 1.5);
    CHECK(edge.integral({0.25, 0.5, 0.5}, {0, 1, 0}, 0.0, 0.0) == 0.0);
}

TEST_CASE("Regular grid: values along one axis are integrated as those of any grid") {
    // The second grid has one other value, in a corner that no line comes to: its cells are gone
    // through one by one.
    std::mt19937_64 rng(3);
    std::uniform_real_distribution<double> u(0, 1);
    const Point low(-1, -2, 0), high(1, 2, 3);
    for (int axis = 0; axis < 3; ++axis)
        for (const BeyondGrid beyond : {BeyondGrid::nothing, BeyondGrid::edge}) {
            std::array<std::size_t, 3> n{6, 5, 4};
            n[static_cast<std::size_t>(axis)] = 9;
            std::vector<double> profile;
            for (int k = 0; k < 9; ++k) profile.push_back(u(rng));
            const auto f = [&](Point p) {
                return profile[static_cast<std::size_t>(
                    std::lround(8.0 * (p[axis] - low[axis]) / (high[axis] - low[axis])))];
            };
            const RegularGrid along = grid_of(n, low, high, f, beyond);
            auto values = along.values();
            values.back() += 1.0f;
            const RegularGrid any(n, low, high, std::move(values), beyond);
            for (int k = 0; k < 200; ++k) {
                Point a = point_in(rng, 1.5 * low, 0.4 * high), b = point_in(rng, low, 0.4 * high);
                // Also along the planes, and nearly so.
                if (k % 4 == 0) b[axis] = a[axis];
                if (k % 4 == 1) b[axis] = a[axis] + 1e-9;
                const double s = glm::distance(a, b);
                const Direction d = (b - a) / s;
                INFO(axis << " " << k);
                CHECK(along.at(b) == Approx(any.at(b)).margin(1e-14));
                CHECK(along.integral(a, d, 0.0, s) ==
                      Approx(any.integral(a, d, 0.0, s)).epsilon(1e-12).margin(1e-14));
            }
        }
}

TEST_CASE("Regular grid: both halves of a way in one go") {
    std::mt19937_64 rng(4);
    std::uniform_real_distribution<double> u(0, 1);
    const Point low(-1, -1, -1), high(1, 1, 1);
    const auto any = grid_of({7, 5, 9}, low, high, [&](Point) { return u(rng); });
    const auto along = grid_of({2, 2, 7}, low, high, [&](Point p) { return std::exp(p.z); });
    for (const RegularGrid* grid : {&any, &along})
        for (int k = 0; k < 100; ++k) {
            const Point a = point_in(rng, 1.5 * low, 1.5 * high);
            const Point b = point_in(rng, 1.5 * low, 1.5 * high);
            const double s = glm::distance(a, b);
            const Direction d = (b - a) / s;
            const auto [first, second] = grid->halves(a, d, 0.0, s);
            CHECK(first == Approx(grid->integral(a, d, 0.0, 0.5 * s)).margin(1e-13));
            CHECK(second == Approx(grid->integral(a, d, 0.5 * s, s)).margin(1e-13));
        }
}

TEST_CASE("Regular grid: the grain is how far apart points may be and miss nothing") {
    const Point low(0, 0, 0), high(4, 4, 4);
    // 64 cells; a slow wave along x, a narrow peak along y, a slope along z.
    const auto grid = grid_of({65, 65, 3}, low, high, [](Point p) {
        return 1.0 + 0.2 * std::sin(p.x) + (std::abs(p.y - 2.0) < 0.01 ? 0.3 : 0.0) + 0.1 * p.z;
    });
    // Half a cell of points apart h departs by 0.2 h²/8 of a wave: of 1.9, 1 % at h = 0.87.
    CHECK(grid.grain().x == 0.5);
    CHECK(grid.grain().y == 0.0625);  // its cells
    CHECK(grid.grain().z == 4.0);     // the box
}

TEST_CASE("Regular grid: what cannot be a grid is refused") {
    const auto message = [](std::array<std::size_t, 3> n, Point high, std::vector<float> values) {
        try {
            RegularGrid(n, {0, 0, 0}, high, std::move(values));
        } catch (const mesh::InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const std::vector<float> eight(8, 1.0f);
    CHECK(message({2, 2, 2}, {1, 1, 1}, eight) == "");
    CHECK_THAT(message({1, 2, 4}, {1, 1, 1}, eight), Contains("1 × 2 × 4 points has no cells"));
    CHECK_THAT(message({2, 2, 3}, {1, 1, 1}, eight), Contains("has 8 values"));
    CHECK_THAT(message({2, 2, 2}, {1, 0, 1}, eight), Contains("no inside"));
    auto bad = eight;
    bad[5] = -2.0f;  // point (1, 0, 1)
    CHECK_THAT(message({2, 2, 2}, {1, 1, 3}, bad), Contains("-2 at its point (1, 0, 1)") &&
                                                       Contains("[1, 0, 3] m") &&
                                                       Contains("negative"));
    bad[5] = std::numeric_limits<float>::quiet_NaN();
    CHECK_THAT(message({2, 2, 2}, {1, 1, 1}, bad), Contains("not a finite number"));
}
