#include "radiosity/elements.h"

#include <cmath>

#include "mesh/input_error.h"
#include "radiosity/start_elements.h"
#include "support/catch.h"
#include "support/rooms.h"

using namespace tyndall;
using namespace tyndall::radiosity;

TEST_CASE("Elements of leaves: all of them, tree by tree", "[elements]") {
    const auto enclosure = make_enclosure(test::slit_room());
    Forest forest(enclosure.mesh);
    for (int k = 0; k < 40; ++k)
        for (const std::size_t z : {std::size_t(3), forest.zone_count() - 1})
            if (forest.is_leaf(ZoneId(z))) {
                const auto [i, j] = forest.longest_edge(ZoneId(z));
                forest.bisect(ZoneId(z), i, j);
            }
    const auto e = elements_of_leaves(enclosure, forest);
    double volume = 0.0;
    std::size_t jumps = 0;
    for (std::size_t k = 0; k < e.zones.size(); ++k) {
        volume += forest.volume(e.zones[k]);
        CHECK(forest.is_leaf(e.zones[k]));
        CHECK(e.of_zone[e.zones[k].value] == e.patches.size() + k);
        if (k > 0) jumps += forest.base_tet(e.zones[k]) < forest.base_tet(e.zones[k - 1]);
    }
    CHECK(volume == Approx(12.0));
    CHECK(jumps == 0);
    for (std::size_t i = 0; i < e.size(); ++i) {
        REQUIRE(e.members_of(i).size() == 1);
        CHECK(e.members_of(i)[0] == (e.is_patch(i) ? e.patches[i].value : e.zone(i).value));
    }
}

TEST_CASE("A place in a cluster is uniform over its members, and stays stratified", "[elements]") {
    const auto enclosure = make_enclosure(test::slit_room());
    const Forest forest(enclosure.mesh);
    const auto e = start_elements(enclosure, forest, Start::single_zone);
    REQUIRE(e.zones.size() == 1);
    CHECK(e.capacity.back() == Approx(4.0 * 0.25 * 12.0));
    const std::size_t zone = e.patches.size();
    constexpr int count = 1 << 16;
    std::vector<double> hits(forest.zone_count(), 0.0), last(forest.zone_count(), -1.0);
    std::size_t unordered = 0, beyond = 0;
    for (int k = 0; k < count; ++k) {
        double u = (k + 0.5) / count;
        const auto member = e.pick_member(zone, u);
        beyond += !(u >= 0.0 && u < 1.0);
        // Numbers in order fall in order within a member, evenly: what is stratified stays so.
        unordered += u <= last[member];
        last[member] = u;
        hits[member] += 1.0;
    }
    CHECK(beyond == 0);
    CHECK(unordered == 0);
    double worst = 0.0;
    for (const auto z : e.members_of(zone)) {  // solid tets are nobody's
        const double expected = forest.volume(ZoneId(z)) / 12.0 * count;
        worst = std::max(worst, std::abs(hits[z] - expected));
    }
    // A member's part of [0, 1) begins and ends somewhere between two of the numbers.
    CHECK(worst <= 1.0 + 1e-6);
}

TEST_CASE("Clusters with several media or surface sides are refused", "[elements]") {
    const auto enclosure = make_enclosure(test::slit_room());
    const Forest forest(enclosure.mesh);
    const OpticalTags tags(enclosure);
    // One tag for every side: coplanar sides of lamp and ceiling become one cluster.
    std::vector<std::uint32_t> sides;
    for (const auto side : tags.facet_sides) sides.push_back(side == none ? none : 0);
    const auto clusters = mesh::make_whole_clusters(enclosure.mesh, {tags.tets, sides});
    CHECK_THROWS_AS(elements_of_clusters(enclosure, forest, clusters), mesh::InputError);
}
