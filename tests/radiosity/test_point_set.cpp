#include "radiosity/point_set.h"
#include "support/catch.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <glm/geometric.hpp>

using namespace tyndall;
using mesh::Direction;
using namespace tyndall::radiosity;

namespace {

// The largest number of points in an elementary interval 2^−a × 2^−b of area 1/count; 1 where the
// pair of dimensions is a (0, m, 2)-net, 2^t where it is a (t, m, 2)-net.
std::size_t most_in_interval(const PointSet& points, std::uint64_t seed, int i, int j) {
    const int m = static_cast<int>(std::log2(double(points.size())) + 0.5);
    std::size_t most = 0;
    for (int a = 0; a <= m; ++a) {
        const std::size_t columns = std::size_t(1) << a, rows = std::size_t(1) << (m - a);
        std::vector<std::size_t> count(points.size(), 0);
        for (std::size_t k = 0; k < points.size(); ++k) {
            const auto u = points(k, seed);
            ++count[std::size_t(u[i] * columns) * rows + std::size_t(u[j] * rows)];
        }
        most = std::max(most, *std::max_element(count.begin(), count.end()));
    }
    return most;
}

}  // namespace

TEST_CASE("Every coordinate is stratified", "[point_set]") {
    for (const std::size_t count : {16, 64, 256, 1024}) {
        const PointSet points(count);
        for (std::uint64_t seed = 0; seed < 5; ++seed)
            for (std::size_t d = 0; d < point_set_dimensions; ++d) {
                std::set<std::size_t> strata;
                for (std::size_t k = 0; k < count; ++k) {
                    const double u = points(k, seed)[d];
                    REQUIRE(u >= 0.0);
                    REQUIRE(u < 1.0);
                    strata.insert(std::size_t(u * double(count)));
                }
                REQUIRE(strata.size() == count);
            }
    }
}

TEST_CASE("Pairs of coordinates are stratified", "[point_set]") {
    // The first pair is a (0, m, 2)-net: exactly one point in every elementary interval; all others
    // are (1, m, 2)-nets: two points at most. Scrambling keeps both (Owen 1995).
    for (const std::size_t count : {64, 256, 1024, 4096}) {
        const PointSet points(count);
        for (int i = 0; i < int(point_set_dimensions); ++i)
            for (int j = i + 1; j < int(point_set_dimensions); ++j) {
                INFO("dimensions " << i << ", " << j << " of " << count);
                CHECK(most_in_interval(points, 7, i, j) <= (i == 0 && j == 1 ? 1 : 2));
            }
    }
}

TEST_CASE("Seeds scramble independently", "[point_set]") {
    // Correlation of the same point's coordinate under two seeds, over many points and seeds: of n
    // independent pairs it has the standard deviation 1/√n; five of them is 1 in 2 million.
    const PointSet points(256);
    for (std::size_t d = 0; d < point_set_dimensions; ++d) {
        double sum = 0.0;
        std::size_t n = 0;
        for (std::uint64_t seed = 0; seed < 400; ++seed)
            for (const std::size_t k : {0, 3, 77, 200, 255}) {
                sum += 12.0 * (points(k, seed)[d] - 0.5) * (points(k, seed + 1)[d] - 0.5);
                ++n;
            }
        CHECK(std::abs(sum) / double(n) < 5.0 / std::sqrt(double(n)));
    }
    // And each place is uniform over the seeds, so that every estimate is unbiased.
    for (const std::size_t k : {0, 1, 100})
        for (std::size_t d = 0; d < point_set_dimensions; ++d) {
            double mean = 0.0;
            constexpr int seeds = 4000;
            for (int seed = 0; seed < seeds; ++seed) mean += points(k, seed)[d] / seeds;
            CHECK(std::abs(mean - 0.5) < 5.0 / std::sqrt(12.0 * seeds));
        }
}

TEST_CASE("Stratified points: one a cell, and one a stratum of the third", "[point_set]") {
    struct Grid {
        std::size_t count;
        std::array<std::size_t, 4> cells;  // along dimensions 0, 1, 3 and 4
    };
    for (const auto& [count, cells] : {Grid{1, {1, 1, 1, 1}}, Grid{16, {2, 2, 2, 2}},
                                       Grid{64, {2, 4, 2, 4}}, Grid{4096, {8, 8, 8, 8}}}) {
        const PointSet points(count, PointSetKind::stratified);
        REQUIRE(points.size() == count);
        for (std::uint64_t seed = 0; seed < 3; ++seed) {
            std::set<std::array<std::size_t, 4>> filled;
            std::set<std::size_t> strata;
            for (std::size_t k = 0; k < count; ++k) {
                const auto u = points(k, seed);
                for (const double coordinate : u) {
                    REQUIRE(coordinate >= 0.0);
                    REQUIRE(coordinate < 1.0);
                }
                filled.insert(
                    {std::size_t(u[0] * double(cells[0])), std::size_t(u[1] * double(cells[1])),
                     std::size_t(u[3] * double(cells[2])), std::size_t(u[4] * double(cells[3]))});
                strata.insert(std::size_t(u[2] * double(count)));
            }
            CAPTURE(count, seed);
            CHECK(filled.size() == count);
            CHECK(strata.size() == count);
        }
    }
}

TEST_CASE("Stratified and independent points are uniform over the seeds", "[point_set]") {
    // Of 7 and of 100 points, which no grid of four dimensions holds all of: the means over 4000
    // seeds of u, u² and of a product of all; each is known to its deviation over √(4000 count).
    for (const auto kind : {PointSetKind::stratified, PointSetKind::independent})
        for (const std::size_t count : {7, 100}) {
            const PointSet points(count, kind);
            constexpr int seeds = 4000;
            std::array<double, point_set_dimensions> mean{}, square{};
            double product = 0.0;
            for (int seed = 0; seed < seeds; ++seed)
                for (std::size_t k = 0; k < count; ++k) {
                    const auto u = points(k, seed);
                    double all = 1.0;
                    for (std::size_t d = 0; d < point_set_dimensions; ++d) {
                        mean[d] += u[d] / double(seeds * count);
                        square[d] += u[d] * u[d] / double(seeds * count);
                        all *= 2.0 * u[d];
                    }
                    product += all / double(seeds * count);
                }
            CAPTURE(count);
            // Deviations of u, u² and Π 2u: 0.289, 0.298 and 1.8; five of each.
            const double n = std::sqrt(double(seeds * count));
            for (std::size_t d = 0; d < point_set_dimensions; ++d) {
                CHECK(std::abs(mean[d] - 0.5) < 5.0 * 0.289 / n);
                CHECK(std::abs(square[d] - 1.0 / 3.0) < 5.0 * 0.298 / n);
            }
            CHECK(std::abs(product - 1.0) < 5.0 * 1.8 / n);
        }
}

TEST_CASE("Sobol' points beat random ones", "[point_set]") {
    // ∫ Π (u_d² + u_d) du = (5/6)^5; random points of this variance have an error of about
    // 0.41/√n. The rate of a scrambled net for a smooth integrand is nearly n^−1.5.
    const auto rms = [](std::size_t count) {
        const PointSet points(count);
        double sum = 0.0;
        for (std::uint64_t seed = 0; seed < 50; ++seed) {
            double mean = 0.0;
            for (std::size_t k = 0; k < count; ++k) {
                double product = 1.0;
                for (const double u : points(k, seed)) product *= u * u + u;
                mean += product / double(count);
            }
            sum += (mean - std::pow(5.0 / 6.0, 5)) * (mean - std::pow(5.0 / 6.0, 5)) / 50.0;
        }
        return std::sqrt(sum);
    };
    const double coarse = rms(64), fine = rms(4096);
    INFO(coarse << " " << fine);
    CHECK(std::log(fine / coarse) / std::log(64.0) < -1.0);
}

TEST_CASE("Places in triangles and tets are uniform", "[point_set]") {
    // Barycentric weights of uniform points: means 1/n, second moments 2/(n(n+1)).
    const PointSet points(4096);
    std::array<double, 3> triangle{}, triangle2{};
    std::array<double, 4> tet{}, tet2{};
    for (std::size_t k = 0; k < points.size(); ++k) {
        const auto u = points(k, 1);
        const auto a = uniform_in_triangle(u[0], u[1]);
        const auto b = uniform_in_tet(u[0], u[1], u[2]);
        for (int c = 0; c < 3; ++c) triangle[c] += a[c] / 4096, triangle2[c] += a[c] * a[c] / 4096;
        for (int c = 0; c < 4; ++c) tet[c] += b[c] / 4096, tet2[c] += b[c] * b[c] / 4096;
        for (const double w : a) REQUIRE(w >= 0.0);
        for (const double w : b) REQUIRE(w >= 0.0);
    }
    // 4096 stratified points: the error is some 1e-4; 1e-3 leaves ten times that.
    for (int c = 0; c < 3; ++c) {
        CHECK(std::abs(triangle[c] - 1.0 / 3.0) < 1e-3);
        CHECK(std::abs(triangle2[c] - 1.0 / 6.0) < 1e-3);
    }
    for (int c = 0; c < 4; ++c) {
        CHECK(std::abs(tet[c] - 0.25) < 1e-3);
        CHECK(std::abs(tet2[c] - 0.1) < 1e-3);
    }
}

TEST_CASE("Directions have the densities 1/4pi and cos/pi", "[point_set]") {
    const PointSet points(4096);
    const Direction n = glm::normalize(Direction(1, -2, 0.5));
    Direction uniform(0.0), cosine(0.0);
    double squares = 0.0, cosines = 0.0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const auto u = points(k, 1);
        const auto a = uniform_direction(u[3], u[4]), b = cosine_direction(n, u[3], u[4]);
        REQUIRE(std::abs(glm::length(a) - 1.0) < 1e-12);
        REQUIRE(std::abs(glm::length(b) - 1.0) < 1e-12);
        REQUIRE(glm::dot(b, n) > 0.0);
        uniform += a / 4096.0;
        cosine += b / 4096.0;
        squares += a.x * a.x / 4096.0;
        cosines += glm::dot(b, n) * glm::dot(b, n) / 4096.0;
    }
    CHECK(glm::length(uniform) < 1e-3);
    CHECK(std::abs(squares - 1.0 / 3.0) < 1e-3);
    CHECK(glm::length(cosine - 2.0 / 3.0 * n) < 1e-3);  // ∫ cos·cos/π dω
    CHECK(std::abs(cosines - 0.5) < 1e-3);              // ∫ cos²·cos/π dω
}
