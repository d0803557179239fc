// Rows with level of detail: coarser columns, and what they must not change.
#include <tbb/global_control.h>

#include <cmath>
#include <map>
#include <numbers>

#include "radiosity/coarse_solution.h"
#include "radiosity/element_mesh.h"
#include "radiosity/exchange_walked.h"
#include "radiosity/row_accumulator.h"
#include "radiosity/solver_gmres.h"
#include "support/catch.h"
#include "support/random_rays.h"
#include "support/rooms.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

struct Room {
    Enclosure enclosure = make_enclosure(test::slit_room());
    ElementMesh mesh{enclosure};
    Elements elements;

    explicit Room(std::size_t zones = 4000, std::size_t patches = 1500) {
        mesh.refine_to({0.0, zones, patches});
        elements = elements_of_leaves(enclosure, mesh.forest());
    }
    ExchangeAreas rows(double detail, std::uint64_t seed = 1, std::size_t rays = 64) const {
        return all_rows(exchange_walked, {enclosure, mesh.forest(), elements},
                        {.rays = rays, .seed = seed, .detail = detail, .progress = {}});
    }
};

// The size of every column: longest edge or extent.
std::vector<double> sizes_of(const Room& room, const RowLevels& levels) {
    std::vector<double> sizes(levels.columns(), 0.0);
    const Forest& forest = room.mesh.forest();
    for (std::size_t z = 0; z < levels.of_zone.size(); ++z)
        if (levels.of_zone[z] != none) sizes[levels.of_zone[z]] = forest[ZoneId(z)].longest_edge;
    for (std::size_t p = 0; p < levels.of_patch.size(); ++p)
        if (levels.of_patch[p] != none) sizes[levels.of_patch[p]] = forest[PatchId(p)].longest_edge;
    for (std::size_t c = 0; c < levels.of_zone_cluster.size(); ++c)
        sizes[levels.of_zone_cluster[c]] = levels.clusters.zones.clusters[c].extent;
    for (std::size_t c = 0; c < levels.of_patch_cluster.size(); ++c)
        sizes[levels.of_patch_cluster[c]] = levels.clusters.patches.clusters[c].extent;
    return sizes;
}

std::uint32_t top(const RowLevels& levels, std::uint32_t column) {
    while (levels.parent[column] != none) column = levels.parent[column];
    return column;
}

}  // namespace

TEST_CASE("Levels: children before parents, shares of one whole, values as means", "[rows]") {
    const Room room;
    const RowLevels levels = make_row_levels(room.enclosure, room.mesh.forest(), room.elements);
    const std::size_t n = room.elements.size();
    REQUIRE(levels.columns() > 3 * n / 2);
    std::vector<double> shares(levels.columns(), 0.0);
    std::size_t out_of_order = 0;
    for (std::size_t c = 0; c < levels.columns(); ++c) {
        const auto parent = levels.parent[c];
        if (parent == none) continue;
        out_of_order += parent <= c || parent <= n;
        shares[parent] += levels.share[c];
    }
    CHECK(out_of_order == 0);
    CHECK(levels.parent[n] == none);  // outside
    double worst = 0.0;
    for (std::size_t c = n + 1; c < levels.columns(); ++c)
        worst = std::max(worst, std::abs(shares[c] - 1.0));
    CHECK(worst < 1e-12);  // volumes of children of a bisection add up but for rounding

    // A linear function: the mean over a tet, weighed by volume, is the value at its centroid.
    const auto f = [](Point x) { return 3.0 + x.x - 2.0 * x.y + 0.5 * x.z; };
    const Forest& forest = room.mesh.forest();
    std::vector<double> values;
    for (const PatchId p : room.elements.patches) values.push_back(f(forest.centroid(p)));
    for (const ZoneId z : room.elements.zones) values.push_back(f(forest.centroid(z)));
    const auto pulled = levels.pull(values);
    worst = 0.0;
    for (std::size_t z = 0; z < forest.zone_count(); ++z)
        if (levels.of_zone[z] != none)
            worst = std::max(worst,
                             std::abs(pulled[levels.of_zone[z]] - f(forest.centroid(ZoneId(z)))));
    for (std::size_t p = 0; p < forest.patch_count(); ++p)
        if (levels.of_patch[p] != none)
            worst = std::max(worst,
                             std::abs(pulled[levels.of_patch[p]] - f(forest.centroid(PatchId(p)))));
    CHECK(worst < 1e-12);
}

TEST_CASE("Rows with level of detail close and are shorter", "[rows]") {
    const Room room;
    const auto without = room.rows(0.0), with = room.rows(4.0);
    CHECK(without.levels.empty());
    CHECK(closure_error(with, room.elements, 0) < 1e-7);
    // With coarser columns the elements' count no longer bounds them.
    CHECK(*std::max_element(with.columns.begin(), with.columns.end()) > room.elements.outside());
    CHECK(with.columns.size() < 0.8 * without.columns.size());
    bool ascending = true;
    for (std::size_t i = 0; i < with.rows(); ++i)
        for (std::size_t k = with.starts[i] + 1; k < with.starts[i + 1]; ++k)
            ascending = ascending && with.columns[k - 1] < with.columns[k];
    CHECK(ascending);
    CHECK(*std::min_element(with.values.begin(), with.values.end()) >= 0.0f);
    // A uniform radiance is seen as such.
    const std::vector<double> ones(room.elements.size(), 1.0);
    const auto received = multiply(with, room.elements, ones);
    double worst = 0.0;
    for (std::size_t i = 0; i < received.size(); ++i)
        worst = std::max(worst, std::abs(received[i] / room.elements.capacity[i] - 1.0));
    CHECK(worst < 1e-6);
}

TEST_CASE("Level of detail moves deposits within the trees, never between them", "[rows]") {
    const Room room;
    const auto without = room.rows(0.0), with = room.rows(4.0);
    const RowLevels& levels = with.levels;
    double worst = 0.0;
    for (std::size_t i = 0; i < with.rows(); ++i) {
        std::vector<double> sums(levels.columns(), 0.0);
        for (std::size_t k = with.starts[i]; k < with.starts[i + 1]; ++k)
            sums[top(levels, with.columns[k])] += with.values[k];
        for (std::size_t k = without.starts[i]; k < without.starts[i + 1]; ++k)
            sums[top(levels, without.columns[k])] -= without.values[k];
        for (const double sum : sums)
            worst = std::max(worst, std::abs(sum) / room.elements.capacity[i]);
    }
    // The same rays; single precision clips a segment at a split plane to 1e-6 of a length at best.
    CHECK(worst < 1e-5);
}

TEST_CASE("A column is no larger than its distance allows", "[rows]") {
    const Room room;
    constexpr double theta = 4.0;
    const auto rows = room.rows(theta);
    const auto sizes = sizes_of(room, rows.levels);
    const double spacing = std::sqrt(4.0 * std::numbers::pi / 64.0);
    const double farthest =
        glm::distance(room.enclosure.mesh.hull_min, room.enclosure.mesh.hull_max);
    const Forest& forest = room.mesh.forest();
    std::vector<Point> centres(rows.levels.columns(), Point(NAN));
    for (std::size_t z = 0; z < forest.zone_count(); ++z)
        if (const auto c = rows.levels.of_zone[z]; c != none)
            centres[c] = forest.centroid(ZoneId(z));
    for (std::size_t p = 0; p < forest.patch_count(); ++p)
        if (const auto c = rows.levels.of_patch[p]; c != none)
            centres[c] = forest.centroid(PatchId(p));
    std::size_t too_large = 0, coarse = 0;
    for (std::size_t i = 0; i < rows.rows(); ++i)
        for (std::size_t k = rows.starts[i]; k < rows.starts[i + 1]; ++k) {
            const auto c = rows.columns[k];
            if (c <= room.elements.outside()) continue;
            ++coarse;
            // From any point of the one to any point of the other; clusters, whose middle is not
            // known here, from one end of the room to the other.
            const double distance =
                std::isnan(centres[c].x)
                    ? farthest
                    : glm::distance(centres[i], centres[c]) + sizes[i] + sizes[c];
            too_large += sizes[c] > 1.0001 * theta * spacing * distance;
        }
    CHECK(coarse > rows.columns.size() / 10);
    CHECK(too_large == 0);
}

TEST_CASE("Level of detail changes the solution by less than its sampling error", "[rows]") {
    const Room room;
    const auto solved = [&](double detail, std::uint64_t seed) {
        const auto areas = room.rows(detail, seed);
        return solve_gmres({room.elements, areas, 0, room.elements.emission}, {1e-9, 200}).radiance;
    };
    const auto difference = [&](const std::vector<double>& a, const std::vector<double>& b) {
        double sum = 0.0;
        for (std::size_t i = 0; i < a.size(); ++i)
            if (!(room.elements.emission[i] > 0.0))
                sum += room.elements.capacity[i] * std::pow(a[i] - b[i], 2);
        return std::sqrt(sum);
    };
    const auto without = solved(0.0, 1);
    const double detail = difference(without, solved(4.0, 1));
    const double noise = difference(without, solved(0.0, 2)) / std::sqrt(2.0);
    INFO(detail << " against " << noise);
    CHECK(detail < noise);
    CHECK(detail > 0.0);
}

TEST_CASE("Rows grow with the logarithm of the elements", "[rows]") {
    const auto entries = [](double detail, std::size_t zones) {
        const Room room(zones, zones / 4);
        return double(room.rows(detail).columns.size()) / double(room.elements.size());
    };
    // A fourfold of zones: cells of 0.63 the size, so that rows without level of detail grow by
    // 1/0.63 at most; with it by what lies nearest, a constant.
    const double added = entries(5.0, 16000) - entries(5.0, 4000);
    const double without = entries(0.0, 16000) - entries(0.0, 4000);
    INFO(added << " " << without);
    CHECK(added < 150.0);
    CHECK(added < 0.5 * without);
}

TEST_CASE("Rows with level of detail have the same bits at one thread and at two", "[rows]") {
    const Room room;
    const auto at = [&](std::size_t threads) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        return room.rows(4.0);
    };
    const auto one = at(1), two = at(2);
    CHECK(one.starts == two.starts);
    CHECK(one.columns == two.columns);
    CHECK(one.values == two.values);
    CHECK(multiply(one, room.elements, room.elements.emission) ==
          multiply(two, room.elements, room.elements.emission));
}

TEST_CASE("Reciprocity of rows with level of detail comes with rays", "[rows]") {
    const Room room(300, 200);
    const double few = reciprocity_error(room.rows(4.0, 1, 64), room.elements);
    const double many = reciprocity_error(room.rows(4.0, 1, 4096), room.elements);
    INFO(few << " " << many);
    // With 4096 rays the spacing is an eighth, and few columns are coarse any more.
    CHECK(many < 0.4 * few);
}

TEST_CASE("Row accumulator: sums by column, ascending, and clean afterwards", "[rows]") {
    RowAccumulator<double> accumulator(100000);
    test::Random random(1);
    for (int round = 0; round < 3; ++round) {
        std::map<std::uint32_t, double> expected;
        for (int k = 0; k < 500; ++k) {
            const auto column = static_cast<std::uint32_t>(test::index_below(random, 100000));
            const double value = double(test::index_below(random, 1000));
            expected[column] += value;
            accumulator.add(column, value);
        }
        accumulator.add(99999, 1.0);
        expected[99999] += 1.0;
        auto next = expected.begin();
        std::size_t wrong = 0;
        accumulator.take([&](std::uint32_t column, double sum) {
            wrong += next == expected.end() || next->first != column || next->second != sum;
            if (next != expected.end()) ++next;
        });
        CHECK(wrong == 0);
        CHECK(next == expected.end());
    }
}
