#include "radiosity/exchange_walked.h"

#include <cmath>

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
