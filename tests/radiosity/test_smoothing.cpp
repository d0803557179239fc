// Smoothing of small matrices: what it promises, and that it does it by the least change.
#include "radiosity/smoothing.h"

#include <cmath>

#include "mesh/input_error.h"
#include "radiosity/report_json.h"
#include "support/catch.h"
#include "support/random_rays.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

constexpr Smoothing methods[]{Smoothing::least_squares, Smoothing::scaling};

// Entry [i][j], outside last; rows of the elements alone.
using Matrix = std::vector<std::vector<double>>;

struct RowsCase {
    Matrix raw;
    Elements elements;

    RowsCase(Matrix matrix, const std::vector<double>& capacity) : raw(std::move(matrix)) {
        elements.patches.resize(capacity.size());
        elements.capacity = capacity;
    }
    ExchangeAreas rows() const {
        ExchangeAreas areas;
        for (std::size_t i = 0; i < raw.size(); ++i) {
            std::vector<std::uint32_t> columns;
            std::vector<double> values;
            for (std::size_t j = 0; j < raw[i].size(); ++j)
                if (raw[i][j] > 0.0) {
                    columns.push_back(static_cast<std::uint32_t>(j));
                    values.push_back(raw[i][j]);
                }
            append(areas, {ElementId(i), columns, values, {}}, Precision::doubled);
        }
        return areas;
    }
    ExchangeAreas smoothed(Smoothing method) const { return smooth(rows(), elements, 0, method); }
    double capacity(std::size_t i) const { return elements.capacity[i]; }
};

Matrix dense(const ExchangeAreas& areas) {
    Matrix result(areas.rows(), std::vector<double>(areas.rows() + 1, 0.0));
    for (std::size_t i = 0; i < areas.rows(); ++i)
        for (std::size_t k = areas.starts[i]; k < areas.starts[i + 1]; ++k)
            result[i][areas.columns[k]] = areas.value(k);
    return result;
}

// A symmetric matrix of n elements whose rows close, with a share of its pairs, and outside for
// every third element.
RowsCase exact(std::size_t n, double filled, std::uint64_t seed) {
    test::Random random(seed);
    Matrix s(n, std::vector<double>(n + 1, 0.0));
    std::vector<double> capacity(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        // A ring beside the random pairs, so that no row is empty.
        for (std::size_t j = 0; j <= i; ++j)
            if (test::uniform(random) < filled || j + 1 == i || (i + 1 == n && j == 0))
                s[i][j] = s[j][i] = std::pow(test::uniform(random), 3);
        if (i % 3 == 0) s[i][n] = test::uniform(random);
    }
    for (std::size_t i = 0; i < n; ++i)
        for (const double entry : s[i]) capacity[i] += entry;
    return {s, capacity};
}

// The same with entries off by up to `noise`, and one of twenty lost.
RowsCase noisy(std::size_t n, double filled, double noise, std::uint64_t seed) {
    RowsCase result = exact(n, filled, seed);
    test::Random random(seed + 1000);
    for (auto& row : result.raw)
        for (double& entry : row) {
            entry *= 1.0 + noise * (2.0 * test::uniform(random) - 1.0);
            if (test::uniform(random) < 0.05) entry = 0.0;
        }
    return result;
}

double mean(const RowsCase& c, std::size_t i, std::size_t j) {
    return j == c.raw.size() ? c.raw[i][j] : 0.5 * (c.raw[i][j] + c.raw[j][i]);
}

// Σ_ij (S'_ij − S̄_ij)² / S̄_ij² over the whole matrix, outside's row as its column: what least
// squares makes least. (To S instead of S̄ it is farther by a constant.)
double squares(const RowsCase& c, const Matrix& smoothed) {
    double sum = 0.0;
    for (std::size_t i = 0; i < c.raw.size(); ++i)
        for (std::size_t j = 0; j <= c.raw.size(); ++j)
            if (const double m = mean(c, i, j); m > 0.0)
                sum += std::pow(smoothed[i][j] / m - 1.0, 2) * (j == c.raw.size() ? 2.0 : 1.0);
    return sum;
}

// Σ_ij S'_ij ln(S'_ij / S̄_ij) − S'_ij + S̄_ij: what scaling makes least.
double divergence(const RowsCase& c, const Matrix& smoothed) {
    double sum = 0.0;
    for (std::size_t i = 0; i < c.raw.size(); ++i)
        for (std::size_t j = 0; j <= c.raw.size(); ++j)
            if (const double m = mean(c, i, j), s = smoothed[i][j]; m > 0.0)
                sum += ((s > 0.0 ? s * std::log(s / m) : 0.0) - s + m) *
                       (j == c.raw.size() ? 2.0 : 1.0);
    return sum;
}

}  // namespace

TEST_CASE("Smoothed rows are reciprocal, close, and are not negative", "[smoothing]") {
    for (const auto method : methods)
        for (const std::size_t n : {3, 10, 60})
            for (std::uint64_t seed = 1; seed <= 5; ++seed) {
                const RowsCase c = noisy(n, 0.3, 0.4, seed);
                CAPTURE(smoothing_name(method), n, seed);
                const ExchangeAreas areas = c.smoothed(method);
                REQUIRE(areas.smoothing);
                REQUIRE(areas.smoothing->converged);
                const Matrix s = dense(areas);
                double least = 0.0, most = 0.0;
                bool kept_zeros = true;
                for (std::size_t i = 0; i < n; ++i) {
                    double sum = 0.0;
                    for (std::size_t j = 0; j <= n; ++j) {
                        sum += s[i][j];
                        least = std::min(least, s[i][j]);
                        // Both sides are made by the same operations.
                        if (j < n) REQUIRE(s[i][j] == s[j][i]);
                        kept_zeros = kept_zeros && (mean(c, i, j) > 0.0 || s[i][j] == 0.0);
                    }
                    most = std::max(most, std::abs(sum / c.capacity(i) - 1.0));
                }
                CHECK(least == 0.0);
                // 1e-12 is asked for, and 48 bits an entry are kept: 4e-15.
                CHECK(most < 1.1e-12);
                CHECK(kept_zeros);
                CHECK(closure_error(areas, c.elements, 0) < 1.1e-12);
                CHECK(reciprocity_error(areas, c.elements) == 0.0);
                CHECK(areas.smoothing->raw_closure_error ==
                      Approx(closure_error(c.rows(), c.elements, 0)));
                CHECK(areas.smoothing->raw_reciprocity_error > 0.1);
            }
}

TEST_CASE("What is right is not moved by smoothing", "[smoothing]") {
    for (const auto method : methods)
        for (const std::size_t n : {3, 10, 60}) {
            const RowsCase c = exact(n, 0.3, n);
            CAPTURE(smoothing_name(method), n);
            const ExchangeAreas areas = c.smoothed(method);
            // 48 bits an entry.
            CHECK(areas.smoothing->moved_max < 1e-14);
            CHECK(areas.smoothing->clamped == 0);
        }
}

TEST_CASE("Each smoothing moves least by its own measure", "[smoothing]") {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const RowsCase c = noisy(20, 0.4, 0.4, seed);
        const Matrix squared = dense(c.smoothed(Smoothing::least_squares));
        const Matrix scaled = dense(c.smoothed(Smoothing::scaling));
        INFO("squares " << squares(c, squared) << " " << squares(c, scaled) << ", divergence "
                        << divergence(c, squared) << " " << divergence(c, scaled));
        CHECK(squares(c, squared) < squares(c, scaled));
        CHECK(divergence(c, scaled) < divergence(c, squared));
        // The sum over the raw matrix is larger by what symmetry alone takes, whatever S' is.
        // Along a ring of four elements entries can go up and down in turn and rows still close:
        // in no such direction is there a lesser change.
        for (std::size_t a = 0; a + 3 < 20; ++a) {
            const std::size_t ring[]{a, a + 1, a + 2, a + 3};
            for (const double step : {1e-5, -1e-5}) {
                Matrix other = squared;
                bool inside = true;
                for (int k = 0; k < 4; ++k) {
                    const auto i = ring[k], j = ring[(k + 1) % 4];
                    other[i][j] = other[j][i] += k % 2 ? -step : step;
                    inside = inside && mean(c, i, j) > 0.0 && other[i][j] >= 0.0;
                }
                if (inside) CHECK(squares(c, other) > squares(c, squared));
            }
        }
    }
}

TEST_CASE("Smoothing of one element in closed form", "[smoothing]") {
    // A zone that lights itself and outside. Least squares: λ (2 S_11² + S_1o²) is what is missing.
    const double self = 0.5, out = 1.2, capacity = 2.0;
    const RowsCase c({{self, out}}, {capacity});
    const double multiplier = (capacity - self - out) / (2.0 * self * self + out * out);
    const Matrix squared = dense(c.smoothed(Smoothing::least_squares));
    CHECK(squared[0][0] == Approx(self + 2.0 * self * self * multiplier).epsilon(1e-12));
    CHECK(squared[0][1] == Approx(out + out * out * multiplier).epsilon(1e-12));
    // Scaling: f² S_11 + f S_1o = c.
    const double f = (-out + std::sqrt(out * out + 4.0 * self * capacity)) / (2.0 * self);
    const Matrix scaled = dense(c.smoothed(Smoothing::scaling));
    CHECK(scaled[0][0] == Approx(f * f * self).epsilon(1e-12));
    CHECK(scaled[0][1] == Approx(f * out).epsilon(1e-12));
    CHECK(c.smoothed(Smoothing::scaling).smoothing->moved_max ==
          Approx((capacity - self - out) / capacity));
}

TEST_CASE("Entries that would become negative are 0 and the rest goes on", "[smoothing]") {
    // 1 to itself and 1 to outside where there is room for 0.1: without the bound λ = −1.9/3 and
    // S'_11 = 1 + 2 λ < 0.
    const RowsCase c({{1.0, 1.0}}, {0.1});
    const ExchangeAreas areas = c.smoothed(Smoothing::least_squares);
    CHECK(areas.smoothing->converged);
    CHECK(areas.smoothing->clamped == 1);
    CHECK(dense(areas)[0][0] == 0.0);
    CHECK(dense(areas)[0][1] == Approx(0.1).epsilon(1e-12));
    // Among many: small entries stay where large ones go to 0, and all still closes.
    std::size_t clamped = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        RowsCase rough = noisy(30, 0.4, 0.98, seed);
        for (double& entry : rough.raw[3]) entry *= 8.0;
        const ExchangeAreas smoothed = rough.smoothed(Smoothing::least_squares);
        CAPTURE(seed);
        CHECK(smoothed.smoothing->converged);
        CHECK(closure_error(smoothed, rough.elements, 0) < 1.1e-12);
        clamped += smoothed.smoothing->clamped;
    }
    CHECK(clamped > 0);
}

TEST_CASE("Rows that cannot close are said to be so", "[smoothing]") {
    // Two patches that see each other alone, one twice the other.
    const RowsCase c({{0.0, 2.0, 0.0}, {1.0, 0.0, 0.0}}, {2.0, 1.0});
    for (const auto method : methods) {
        const ExchangeAreas areas = c.smoothed(method);
        CAPTURE(smoothing_name(method));
        CHECK_FALSE(areas.smoothing->converged);
        const Matrix s = dense(areas);
        CHECK(s[0][1] == s[1][0]);
        CHECK(std::isfinite(s[0][1]));
        CHECK(closure_error(areas, c.elements, 0) > 0.1);
    }
}

TEST_CASE("Smoothing scales moments with their entries", "[smoothing]") {
    const RowsCase c({{0.0, 1.0, 1.0}, {2.0, 0.5, 0.0}}, {2.0, 2.5});
    ExchangeAreas raw = c.rows();
    raw.moments = {{1, 2, 3}, {0, 0, 0}, {0, 1, 0}, {0, 0, 2}};
    const ExchangeAreas smoothed = smooth(raw, c.elements, 0, Smoothing::scaling);
    REQUIRE(smoothed.moments.size() == smoothed.columns.size());
    // The mean place, moment over entry, is what it was. Moments are single.
    CHECK(smoothed.moments[0].z / smoothed.value(0) == Approx(3.0).epsilon(1e-6));
    CHECK(smoothed.moments[2].y / smoothed.value(2) == Approx(0.5).epsilon(1e-6));
    CHECK(smoothed.moments[3].z / smoothed.value(3) == Approx(4.0).epsilon(1e-6));
}

TEST_CASE("Elements without capacity have no part in smoothing", "[smoothing]") {
    // A medium with extinction in another band only.
    const RowsCase c({{0.5, 0.0, 1.2}, {0.0, 0.0, 0.0}}, {2.0, 0.0});
    for (const auto method : methods) {
        const ExchangeAreas areas = c.smoothed(method);
        CHECK(areas.smoothing->converged);
        CHECK(closure_error(areas, c.elements, 0) < 1.1e-12);
    }
}

TEST_CASE("Smoothing refuses level of detail", "[smoothing]") {
    const RowsCase c = exact(3, 0.5, 1);
    ExchangeAreas raw = c.rows();
    raw.levels.parent.assign(5, none);
    CHECK_THROWS_AS(smooth(raw, c.elements, 0, Smoothing::scaling), mesh::InputError);
    CHECK_THROWS_AS(check_smoothing(Smoothing::least_squares, 5.0), mesh::InputError);
    CHECK_NOTHROW(check_smoothing(Smoothing::none, 5.0));
    CHECK_NOTHROW(check_smoothing(Smoothing::least_squares, 0.0));
}

TEST_CASE("Reports say what smoothing did, files without it too", "[smoothing]") {
    Report report;
    CHECK(report_to_json(report, Costs::kept).find("smoothing") == std::string::npos);
    CHECK_FALSE(report_from_json(report_to_json(report, Costs::kept)).smoothing);
    report.smoothing = SmoothingReport{Smoothing::scaling, 1e-7, 0.3, 0.5, 0.25, 7, 42, false};
    const auto read = report_from_json(report_to_json(report, Costs::left_out));
    REQUIRE(read.smoothing);
    CHECK(read.smoothing->method == Smoothing::scaling);
    CHECK(read.smoothing->raw_closure_error == 1e-7);
    CHECK(read.smoothing->raw_reciprocity_error == 0.3);
    CHECK(read.smoothing->moved_max == 0.5);
    CHECK(read.smoothing->moved_mean == 0.25);
    CHECK(read.smoothing->clamped == 7);
    CHECK(read.smoothing->iterations == 42);
    CHECK_FALSE(read.smoothing->converged);
    CHECK_THROWS_AS(smoothing_named("ironing"), mesh::InputError);
}
