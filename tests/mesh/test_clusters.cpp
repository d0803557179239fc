#include "mesh/clusters.h"

#include <algorithm>
#include <set>

#include "mesh/cluster_graph.h"
#include "mesh/walk.h"
#include "support/box_mesh.h"
#include "support/catch.h"
#include "support/random_rays.h"

using namespace tyndall;
using namespace tyndall::mesh;

namespace {

enum class Partition { none, with_slit, closed };

// A room of 4 × 2 × 2 cells of 1 m, walls all around. Across it at x = 2 a partition, that leaves a
// slit at y > 1, z > 1; in the right half at y = 1 a low wall, which stands on the floor.
test::FaceAt walls_of(Partition partition) {
    return [=](Point c, int axis) -> std::optional<test::Face> {
        if (c[axis] == 0.0) return test::Face{Opacity::opaque, 0, radiosity::none};
        if (c[axis] == (axis == 0 ? 4.0 : 2.0))
            return test::Face{Opacity::opaque, radiosity::none, 0};
        const bool open = partition == Partition::with_slit && c.y > 1.0 && c.z > 1.0;
        if (axis == 0 && c.x == 2.0 && partition != Partition::none && !open)
            return test::Face{Opacity::opaque, 1, 2};
        if (axis == 1 && c.y == 1.0 && c.x > 2.0 && c.z < 1.0 && partition != Partition::none)
            return test::Face{Opacity::opaque, 3, 4};
        return std::nullopt;
    };
}

struct Room {
    BaseMesh mesh;
    std::vector<std::uint32_t> tets, facet_sides;

    explicit Room(Partition partition, int cells = 2) {
        std::array<std::vector<double>, 3> lines;
        for (int axis = 0; axis < 3; ++axis)
            for (int k = 0; k <= (axis == 0 ? 4 : 2) * cells; ++k)
                lines[axis].push_back(double(k) / cells);
        const auto enclosure = test::box_enclosure(lines, walls_of(partition));
        mesh = enclosure.mesh;
        tets.assign(mesh.tets.size(), 0);
        for (const auto& sides : enclosure.facet_sides)
            facet_sides.insert(facet_sides.end(), {sides[0], sides[1]});
    }
    ClusterTags tags() const { return {tets, facet_sides}; }
};

Point point_in(const BaseMesh& mesh, std::span<const VertexId> corners, test::Random& random) {
    double sum = 0.0;
    Point x(0.0);
    for (const VertexId v : corners) {
        const double w = -std::log1p(-test::uniform(random));
        x += w * mesh.points[v.value];
        sum += w;
    }
    return x / sum;
}

// Whether light goes straight from a to b.
bool sees(const BaseMesh& mesh, Point a, Point b) {
    const Direction d = b - a;
    const double length = glm::length(d);
    if (length < 1e-9) return true;
    return walk(mesh, {a, d / length, length}, {locate(mesh, a)}, [](TetId, double, double) {
               return true;
           }).arrival == Arrival::ended;
}

std::vector<ClusterId> roots(const ClusterTree& tree) {
    std::vector<ClusterId> result;
    for (std::size_t c = 0; c < tree.clusters.size(); ++c)
        if (!tree.clusters[c].parent.valid()) result.push_back(ClusterId(c));
    return result;
}

void check_nesting(const ClusterTree& tree) {
    std::size_t wrong = 0;
    for (std::size_t c = 0; c < tree.clusters.size(); ++c) {
        const Cluster& cluster = tree.clusters[c];
        if (cluster.end - cluster.begin < 2) ++wrong;
        if (!cluster.parent.valid()) continue;
        const Cluster& parent = tree.clusters[cluster.parent.value];
        if (cluster.parent.value >= c || cluster.begin < parent.begin || cluster.end > parent.end ||
            cluster.end - cluster.begin >= parent.end - parent.begin ||
            cluster.extent > parent.extent)
            ++wrong;
    }
    CHECK(wrong == 0);
    for (std::size_t k = 0; k < tree.members.size(); ++k)
        if (const ClusterId above = tree.above[tree.members[k]]; above.valid()) {
            const Cluster& c = tree.clusters[above.value];
            REQUIRE(c.begin <= k);
            REQUIRE(k < c.end);
        }
    auto members = tree.members;
    std::sort(members.begin(), members.end());
    CHECK(std::adjacent_find(members.begin(), members.end()) == members.end());
}

}  // namespace

TEST_CASE("An empty room is one zone cluster and a patch cluster a wall", "[clusters]") {
    const Room room(Partition::none);
    const Clusters clusters = make_clusters(room.mesh, room.tags());
    check_nesting(clusters.zones);
    check_nesting(clusters.patches);
    const auto zones = roots(clusters.zones), patches = roots(clusters.patches);
    REQUIRE(zones.size() == 1);
    CHECK(clusters.zones.members_of(zones[0]).size() == room.mesh.tets.size());
    // From corner to corner: sqrt(16 + 4 + 4) is the length, along (1,1,1) it is 8 / sqrt 3.
    CHECK(clusters.zones.clusters[0].extent == Approx(8.0 / std::sqrt(3.0)));
    CHECK(patches.size() == 6);
    // Down to single tets: one less than there are tets if every split were in two pieces.
    CHECK(clusters.zones.clusters.size() < room.mesh.tets.size());
    CHECK(clusters.zones.clusters.size() > room.mesh.tets.size() / 2);
}

TEST_CASE("No wall stands in a cluster: all its points see each other", "[clusters]") {
    for (const auto partition : {Partition::with_slit, Partition::closed}) {
        const Room room(partition);
        const Clusters clusters = make_clusters(room.mesh, room.tags());
        check_nesting(clusters.zones);
        test::Random random(1);
        std::size_t hidden = 0;
        for (std::size_t c = 0; c < clusters.zones.clusters.size(); ++c) {
            const auto members = clusters.zones.members_of(ClusterId(c));
            for (int k = 0; k < 20; ++k) {
                const auto any = [&] {
                    return point_in(
                        room.mesh,
                        room.mesh.tets[members[test::index_below(random, members.size())]], random);
                };
                const Point a = any(), b = any();
                if (!sees(room.mesh, a, b)) ++hidden;
            }
        }
        CHECK(hidden == 0);
        // Something is left to cluster: the halves, cut once more by the low wall.
        const auto zones = roots(clusters.zones);
        CHECK(zones.size() <= 6);
        CHECK(clusters.zones.clusters.size() > room.mesh.tets.size() / 2);
    }
}

TEST_CASE("Patch clusters lie flat on one side of one surface, with nothing standing on them",
          "[clusters]") {
    const Room room(Partition::with_slit);
    const Clusters clusters = make_clusters(room.mesh, room.tags());
    check_nesting(clusters.patches);
    REQUIRE(roots(clusters.patches).size() > 10);
    test::Random random(2);
    std::size_t hidden = 0, mixed = 0;
    for (std::size_t c = 0; c < clusters.patches.clusters.size(); ++c) {
        const auto members = clusters.patches.members_of(ClusterId(c));
        const auto any = [&] {
            const auto side = members[test::index_below(random, members.size())];
            const Direction up = (side % 2 ? -1.0 : 1.0) * normal(room.mesh, FacetId(side / 2));
            return point_in(room.mesh, room.mesh.facets[side / 2].corners, random) + 1e-3 * up;
        };
        for (const auto side : members)
            if (room.facet_sides[side] != room.facet_sides[members[0]]) ++mixed;
        for (int k = 0; k < 20; ++k) {
            const Point a = any(), b = any();
            if (!sees(room.mesh, a, b)) ++hidden;
        }
    }
    CHECK(mixed == 0);
    CHECK(hidden == 0);
}

TEST_CASE("Whole clusters: a zone a part of a medium, a patch a side of a polygon", "[clusters]") {
    for (const auto& [partition, parts] :
         {std::pair{Partition::none, 1u}, {Partition::with_slit, 1u}, {Partition::closed, 2u}}) {
        const Room room(partition);
        const auto light_tight = light_tight_parts(room.mesh);
        CHECK(std::set(light_tight.begin(), light_tight.end()).size() == parts);
        const Clusters whole = make_whole_clusters(room.mesh, room.tags());
        CHECK(whole.zones.clusters.size() == parts);
        // Six walls of the room, four of them in two parts if closed; two sides each of partition
        // and low wall.
        const std::size_t patches = 6 + (parts == 2 ? 4 : 0) + (partition != Partition::none) * 4;
        CHECK(whole.patches.clusters.size() == patches);
        double total = 0.0;
        for (const auto side : whole.patches.members) total += area(room.mesh, FacetId(side / 2));
        CHECK(total == Approx(40.0 + (partition == Partition::none
                                          ? 0.0
                                          : 2.0 * (parts == 2 ? 4.0 : 3.0) + 2.0 * 2.0)));
    }
}

TEST_CASE("Media and interfaces: zones keep to their tag, and a whole one passes an interface",
          "[clusters]") {
    auto enclosure = test::box_enclosure({{{0, 1, 2, 3}, {0, 1}, {0, 1}}},
                                         [](Point c, int axis) -> std::optional<test::Face> {
                                             if (axis == 0 && (c.x == 1.0 || c.x == 2.0))
                                                 return test::Face{Opacity::interface};
                                             return std::nullopt;
                                         });
    std::vector<std::uint32_t> tets(enclosure.mesh.tets.size(), 7);
    std::vector<std::uint32_t> sides(2 * enclosure.mesh.facets.size(), untagged);
    const auto one = make_whole_clusters(enclosure.mesh, {tets, sides});
    CHECK(one.zones.clusters.size() == 1);
    CHECK(one.patches.clusters.empty());
    for (std::size_t t = 0; t < tets.size(); ++t) {
        double x = 0.0;
        for (const VertexId v : enclosure.mesh.tets[t])
            x += 0.25 * enclosure.mesh.points[v.value].x;
        if (x > 1.0 && x < 2.0) tets[t] = untagged;  // the two ends no longer touch
    }
    const auto ends = make_whole_clusters(enclosure.mesh, {tets, sides});
    REQUIRE(ends.zones.clusters.size() == 2);
    CHECK(ends.zones.members.size() == 12);
    const auto split = make_clusters(enclosure.mesh, {tets, sides});
    CHECK(roots(split.zones).size() == 2);
}
