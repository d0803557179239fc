#include "radiosity/exchange_walked.h"

#include <cmath>

#include "radiosity/point_set.h"
#include "support/catch.h"
#include "support/crowded_cube.h"
#include "support/cube.h"

using namespace tyndall;
using namespace tyndall::radiosity;

TEST_CASE("Walked rows close, and no entry is negative", "[exchange]") {
    const auto enclosure = test::crowded_cube();
    Forest forest(enclosure.mesh);
    test::bisect_some(forest, 60);
    const auto elements = elements_of_leaves(enclosure, forest);
    const auto areas =
        all_rows(exchange_walked, {enclosure, forest, elements}, {.rays = 128, .progress = {}});
    REQUIRE(areas.rows() == elements.size());
    // Each of 128 rays gives away what it has. Entries are kept in single precision, each with
    // what rounding left of the one before: what remains is at most the last one's, 6e-8 of it.
    CHECK(closure_error(areas, elements, 0) < 1e-7);
    bool ascending = true;
    double least = 0.0, outside = 0.0;
    for (std::size_t i = 0; i < areas.rows(); ++i)
        for (std::size_t k = areas.starts[i]; k < areas.starts[i + 1]; ++k) {
            least = std::min(least, double(areas.values[k]));
            if (areas.columns[k] == elements.outside()) outside += areas.values[k];
            if (k > areas.starts[i])
                ascending = ascending && areas.columns[k - 1] < areas.columns[k];
        }
    CHECK(least >= 0.0);
    CHECK(ascending);
    CHECK(outside > 0.0);
}

TEST_CASE("A wall does not exchange with its own plane", "[exchange]") {
    const auto sums = test::group_exchange({.extinction = 0.5, .cells = 2}, 64, 1);
    for (std::size_t wall = 0; wall < 6; ++wall) CHECK(sums[wall][wall] == 0.0);
}

TEST_CASE("Rows asked for are the rows given, whatever the order", "[exchange]") {
    const auto enclosure = test::crowded_cube();
    const Forest forest(enclosure.mesh);
    const auto elements = elements_of_leaves(enclosure, forest);
    const Discretization d{enclosure, forest, elements};
    const auto all = all_rows(exchange_walked, d, {.rays = 64, .progress = {}});
    const std::vector<ElementId> some{ElementId(7), ElementId(elements.size() - 1), ElementId(0)};
    std::size_t next = 0;
    exchange_walked(d, some, {.rays = 64, .progress = {}}, [&](const Row& row) {
        const auto [id, columns, values, moments] = row;
        REQUIRE(moments.empty());
        REQUIRE(id == some[next++]);
        const auto begin = all.starts[id.value];
        REQUIRE(columns.size() == all.starts[id.value + 1] - begin);
        for (std::size_t k = 0; k < columns.size(); ++k) {
            REQUIRE(columns[k] == all.columns[begin + k]);
            // What is kept is rounded, and has the rounding of the entry before added.
            REQUIRE(all.values[begin + k] == Approx(values[k]).epsilon(1e-6).margin(1e-9));
        }
    });
    CHECK(next == some.size());
}

TEST_CASE("Rows of several bands from one walk are each band's own, to the bit", "[exchange]") {
    const bool varying = GENERATE(false, true);
    const auto radiance = GENERATE(Radiance::constant, Radiance::linear);
    const double radius = GENERATE(0.0, 0.7);
    auto enclosure = test::crowded_cube();
    // 13 bands are walked eight, four and one at a time.
    enclosure.bands = 13;
    for (auto& side : enclosure.sides) {
        side.reflectance.assign(13, 0.5);
        side.emission.assign(13, 0.0);
    }
    auto& medium = enclosure.media[0];
    medium = {"haze", Spectrum(13), Spectrum(13, 0.9), Spectrum(13, 0.0), Spectrum(13)};
    const auto sample = [](double thickens) {
        return sample_function([=](Point p) { return 0.1 + p.x + thickens * p.z * p.z; }, {0, 0, 0},
                               {2, 2, 2}, {.tolerance = 1e-2})
            .grid;
    };
    const auto one = sample(0.5), other = sample(2.0);
    for (std::size_t b = 0; b < 13; ++b) {
        medium.extinction[b] = 0.1 + 0.3 * double(b);
        // Bands share a shape, or one of the factors, or neither.
        if (varying) medium.varying.push_back({b % 5 < 3 ? one : other, 0.2 + double(b / 2)});
    }
    Forest forest(enclosure.mesh);
    test::bisect_some(forest, 20);
    const auto elements = elements_of_leaves(enclosure, forest);
    const Discretization d{enclosure, forest, elements};
    ExchangeOptions options{.rays = 32, .radiance = radiance};
    options.settings.interaction_radius = radius;
    std::vector<std::size_t> bands;
    for (std::size_t b = 13; b-- > 0;) bands.push_back(b);
    const auto together = all_rows(exchange_walked_bands, d, options, bands);
    REQUIRE(together.size() == 13);
    for (std::size_t k = 0; k < 13; ++k) {
        options.band = bands[k];
        const auto alone = all_rows(exchange_walked, d, options);
        CAPTURE(varying, int(radiance), radius, bands[k]);
        CHECK(together[k].starts == alone.starts);
        CHECK(together[k].columns == alone.columns);
        CHECK(together[k].values == alone.values);
        CHECK(together[k].moments == alone.moments);
        CHECK(alone.moments.empty() == (radiance == Radiance::constant));
        CHECK(closure_error(together[k], elements, bands[k]) < 1e-7);
    }
    CHECK(together[0].values != together[12].values);
}

TEST_CASE("A band in which a medium is transparent walks with others", "[exchange]") {
    auto enclosure = test::crowded_cube();
    enclosure.bands = 2;
    for (auto& side : enclosure.sides) {
        side.reflectance.assign(2, 0.5);
        side.emission.assign(2, 0.0);
    }
    enclosure.media[0] = {"haze", {0.0, 0.6}, {0.0, 0.9}, {0.0, 0.0}, {0.0, 0.06}};
    Forest forest(enclosure.mesh);
    test::bisect_some(forest, 20);
    const auto elements = elements_of_leaves(enclosure, forest);
    const Discretization d{enclosure, forest, elements};
    ExchangeOptions options{.rays = 64, .radiance = Radiance::linear};
    const std::vector<std::size_t> bands{0, 1};
    const auto together = all_rows(exchange_walked_bands, d, options, bands);
    for (std::size_t b = 0; b < 2; ++b) {
        options.band = b;
        const auto alone = all_rows(exchange_walked, d, options);
        const std::vector<double> ones(elements.size(), 1.0);
        const auto expected = multiply(alone, elements, ones);
        const auto found = multiply(together[b], elements, ones);
        for (std::size_t i = 0; i < elements.size(); ++i)
            CHECK(found[i] == Approx(expected[i]).epsilon(1e-6).margin(1e-12));
    }
    // A zone has no row where it is transparent, and no column has anything in it.
    const auto zone = elements.patches.size();
    CHECK(elements.capacity[2 * zone] == 0.0);
    for (std::size_t k = 0; k < together[0].columns.size(); ++k)
        if (together[0].columns[k] >= zone && together[0].columns[k] != elements.outside())
            CHECK(together[0].values[k] == 0.0f);
}

TEST_CASE("Reciprocity comes with rays", "[exchange]") {
    const auto enclosure = test::crowded_cube();
    const Forest forest(enclosure.mesh);
    const auto elements = elements_of_leaves(enclosure, forest);
    const auto error = [&](std::size_t rays) {
        return reciprocity_error(all_rows(exchange_walked, {enclosure, forest, elements},
                                          {.rays = rays, .progress = {}}),
                                 elements);
    };
    const double coarse = error(64), fine = error(4096);
    INFO(coarse << " " << fine);
    // Independent rays would have the rate 1/2; Sobol' points do better than that.
    CHECK(std::log(fine / coarse) / std::log(64.0) < -0.55);
}

TEST_CASE("Closure and reciprocity errors are what their headers say", "[exchange]") {
    Elements elements;
    elements.patches.resize(3);
    elements.capacity = {2.0, 4.0, 1.0};
    // S_01 = 1, S_10 = 3, S_12 = 1 without a S_21; outside is column 3.
    ExchangeAreas areas;
    areas.starts = {0, 2, 4, 5};
    areas.columns = {1, 3, 0, 2, 3};
    areas.values = {1.0f, 1.0f, 3.0f, 1.0f, 0.5f};
    CHECK(closure_error(areas, elements, 0) == 0.5);
    // Σ_ij |S_ij − S_ji| = 2·2 + 2·1 over Σ S_ij = 5.
    CHECK(reciprocity_error(areas, elements) == Approx(6.0 / 5.0));
}

TEST_CASE("Reciprocity of long rows is estimated from a part of each", "[exchange]") {
    // S_ij of any two elements are apart by as much as two uniform numbers from 1 to 2, but for a
    // half of the elements, which are reciprocal among themselves and have shorter rows.
    constexpr std::uint32_t n = 1200, half = n / 2;
    Elements elements;
    elements.patches.resize(n);
    elements.capacity.assign(n, 1.0);
    ExchangeAreas areas;
    double difference = 0.0, total = 0.0;
    const auto entry = [](std::uint32_t i, std::uint32_t j) {
        return 1.0f + 0x1p-53f * static_cast<float>(hash_seed(i, j) >> 11);
    };
    for (std::uint32_t i = 0; i < n; ++i) {
        const bool first = i < half;
        for (std::uint32_t j = first ? 0 : half; j < (first ? half : n); ++j) {
            areas.columns.push_back(j);
            areas.values.push_back(first ? 1.0f : entry(i, j));
            total += areas.values.back();
            if (!first) difference += std::abs(entry(i, j) - entry(j, i));
        }
        areas.starts.push_back(areas.columns.size());
    }
    CHECK(reciprocity_error(areas, elements) == Approx(difference / total).epsilon(0.03));
}
