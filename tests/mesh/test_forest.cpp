#include "mesh/forest.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "support/box_mesh.h"
#include "support/catch.h"
#include "support/ray_scenes.h"

using namespace tyndall;
using namespace tyndall::mesh;

namespace {

// One volume or area is a sum of a few products; 1e-12 leaves a factor of a thousand over rounding.
constexpr double forest_rounding = 1e-12;

BaseMesh grid() {
    return test::box_enclosure({{{0, 0.5, 2}, {0, 1}, {0, 1, 1.25}}},
                               [](Point c, int axis) -> std::optional<test::Face> {
                                   if (axis == 2 && c.z == 1.0) return test::Face{};
                                   return c[axis] == 0.0 ? std::optional(test::Face{})
                                                         : std::nullopt;
                               })
        .mesh;
}

template <class Node>
Node random_leaf(const Forest& forest, std::size_t count, test::Random& random) {
    Node node(test::index_below(random, count));
    while (!forest.is_leaf(node)) node = Node(forest[node].first_child.value + random() % 2);
    return node;
}

// Bisects leaves at random edges (not the longest only) and random places.
void refine_at_random(Forest& forest, int steps, test::Random& random) {
    for (int k = 0; k < steps; ++k) {
        const double t = random() % 2 ? 0.5 : test::uniform(random, 0.05, 0.95);
        if (random() % 2) {
            const auto zone = random_leaf<ZoneId>(forest, forest.zone_count(), random);
            auto edge = forest.longest_edge(zone);
            if (random() % 4 == 0) edge = {int(random() % 2), 2 + int(random() % 2)};
            if (random() % 2) std::swap(edge[0], edge[1]);
            forest.bisect(zone, edge[0], edge[1], t);
        } else {
            const auto patch = random_leaf<PatchId>(forest, forest.patch_count(), random);
            const auto edge = forest.longest_edge(patch);
            forest.bisect(patch, edge[0], edge[1], t);
        }
    }
}

glm::dvec3 area_vector(const Forest& forest, PatchId id) {
    const auto& c = forest[id].corners;
    const Point a = forest.point(c[0]);
    return 0.5 * glm::cross(forest.point(c[1]) - a, forest.point(c[2]) - a);
}

}  // namespace

TEST_CASE("Roots are the tets and the facet sides", "[forest]") {
    const BaseMesh mesh = grid();
    const Forest forest(mesh);
    REQUIRE(forest.zone_count() == mesh.tets.size());
    REQUIRE(forest.patch_count() == 2 * mesh.facets.size());
    for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
        const auto up = area_vector(forest, root_patch(FacetId(f), Side::front));
        const auto down = area_vector(forest, root_patch(FacetId(f), Side::back));
        // The same numbers in another order.
        CHECK(glm::length(up + down) < forest_rounding);
        CHECK(glm::dot(up, normal(mesh, FacetId(f))) > 0.0);
    }
}

TEST_CASE("Children tile their parents", "[forest]") {
    const BaseMesh mesh = grid();
    Forest forest(mesh);
    test::Random random(1);
    refine_at_random(forest, 4000, random);
    std::size_t wrong_volume = 0, wrong_area = 0, turned = 0, wrong_side = 0;
    for (std::size_t z = 0; z < forest.zone_count(); ++z) {
        const ZoneId parent(z);
        turned += !(forest.volume(parent) > 0.0);
        if (forest.is_leaf(parent)) continue;
        const ZoneId first = forest[parent].first_child, second(first.value + 1ull);
        const double sum = forest.volume(first) + forest.volume(second);
        // A volume's rounding goes with the coordinates (about 2 m), not with the volume itself.
        wrong_volume += std::abs(sum - forest.volume(parent)) > forest_rounding;
        for (const auto& [child, sign] : {std::pair{first, -1.0}, std::pair{second, 1.0}}) {
            const double height = glm::dot(forest[parent].plane_normal, forest.centroid(child)) +
                                  forest[parent].plane_offset;
            wrong_side += !(sign * height > 0.0);
            wrong_side += forest[child].parent != parent;
            wrong_side += forest[child].level != forest[parent].level + 1;
            wrong_side += forest.base_tet(child) != forest.base_tet(parent);
        }
    }
    for (std::size_t p = 0; p < forest.patch_count(); ++p) {
        const PatchId parent(p);
        if (forest.is_leaf(parent)) continue;
        const PatchId first = forest[parent].first_child, second(first.value + 1ull);
        const auto a = area_vector(forest, first), b = area_vector(forest, second);
        wrong_area += glm::length(a + b - area_vector(forest, parent)) > forest_rounding;
        turned += !(glm::dot(a, area_vector(forest, parent)) > 0.0) ||
                  !(glm::dot(b, area_vector(forest, parent)) > 0.0);
        wrong_side += glm::dot(forest[parent].plane_normal, forest.centroid(first)) +
                          forest[parent].plane_offset >=
                      0.0;
    }
    CHECK(wrong_volume == 0);
    CHECK(wrong_area == 0);
    CHECK(turned == 0);
    CHECK(wrong_side == 0);
}

TEST_CASE("The leaf at a point holds the point", "[forest]") {
    const BaseMesh mesh = grid();
    Forest forest(mesh);
    test::Random random(2);
    refine_at_random(forest, 4000, random);
    for (int k = 0; k < 20000; ++k) {
        const TetId tet(test::index_below(random, mesh.tets.size()));
        const Point x = test::point_in_tet(mesh, tet, random);
        const ZoneId leaf = forest.leaf_at(root_zone(tet), x);
        REQUIRE(forest.is_leaf(leaf));
        REQUIRE(forest.base_tet(leaf) == tet);
        REQUIRE(test::outside_tet([&](int c) { return forest.point(forest[leaf].corners[c]); }, x) <
                forest_rounding);
    }
    for (int k = 0; k < 20000; ++k) {
        const PatchId root(test::index_below(random, 2 * mesh.facets.size()));
        const auto w = test::random_weights<3>(random);
        Point x(0.0);
        for (int c = 0; c < 3; ++c) x += w[c] * forest.point(forest[root].corners[c]);
        const PatchId leaf = forest.leaf_at(root, x);
        REQUIRE(forest.is_leaf(leaf));
        REQUIRE(forest.base_facet_side(leaf) == root.value);
        const auto normal = glm::normalize(area_vector(forest, leaf));
        const auto& corners = forest[leaf].corners;
        for (int c = 0; c < 3; ++c) {
            const Point a = forest.point(corners[c]);
            const auto edge = forest.point(corners[(c + 1) % 3]) - a;
            REQUIRE(glm::dot(glm::cross(normal, edge), x - a) / glm::length(edge) >
                    -forest_rounding);
        }
    }
}

TEST_CASE("Tets and triangles around an edge share its vertex", "[forest]") {
    const BaseMesh mesh = grid();
    Forest forest(mesh);
    const auto& corners = mesh.facets[0].corners;
    const VertexId middle = forest.vertex_on_edge(corners[0], corners[1]);
    CHECK(forest.vertex_on_edge(corners[1], corners[0]) == middle);
    const PatchId front = root_patch(FacetId(0), Side::front);
    const auto place = [&](const auto& ids, VertexId v) {
        return int(std::find(ids.begin(), ids.end(), v) - ids.begin());
    };
    const auto child = forest.bisect(front, place(forest[front].corners, corners[0]),
                                     place(forest[front].corners, corners[1]));
    const auto& of_child = forest[child].corners;
    CHECK(std::find(of_child.begin(), of_child.end(), middle) != of_child.end());
    const Carrier expected = corners[0] < corners[1] ? Carrier{corners[0], corners[1], {}, {}}
                                                     : Carrier{corners[1], corners[0], {}, {}};
    CHECK(forest.carrier(middle) == expected);
}

TEST_CASE("An edge has the same vertex at t from either end", "[forest]") {
    const BaseMesh mesh = grid();
    Forest forest(mesh);
    test::Random random(7);
    const VertexId a = mesh.facets[0].corners[0], b = mesh.facets[0].corners[1];
    for (int k = 0; k < 2000; ++k) {
        // Any t, short ones too: of the plain ones, half change when flipped twice.
        const double t = std::pow(test::uniform(random, 0.0, 1.0), 4.0) * 0.99 + 0.005;
        const double place = Forest::place(t);
        CHECK(std::abs(place - t) < 1e-15);
        CHECK(1.0 - (1.0 - place) == place);
        const VertexId vertex = forest.vertex_on_edge(a, b, t);
        CHECK(forest.vertex_on_edge(b, a, 1.0 - place) == vertex);
        CHECK(forest.vertex_on_edge(a, b, place) == vertex);
    }
    // Two tets on an edge that are cut at t, each from its own end, share the vertex.
    const std::size_t before = forest.vertex_count();
    const VertexId vertex = forest.vertex_on_edge(a, b, 1.0 / 3.0);
    CHECK(forest.vertex_count() == before + 1);
    int cut = 0;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        const auto& corners = mesh.tets[t];
        const auto i = std::find(corners.begin(), corners.end(), cut % 2 ? b : a);
        const auto j = std::find(corners.begin(), corners.end(), cut % 2 ? a : b);
        if (i == corners.end() || j == corners.end()) continue;
        const double from_a = Forest::place(1.0 / 3.0);
        forest.bisect(ZoneId(t), int(i - corners.begin()), int(j - corners.begin()),
                      cut % 2 ? 1.0 - from_a : from_a);
        ++cut;
    }
    CHECK(cut >= 2);
    CHECK(forest.vertex_count() == before + 1);
    CHECK(forest.vertex_edges().back().t ==
          (a < b ? Forest::place(1.0 / 3.0) : 1.0 - Forest::place(1.0 / 3.0)));
    CHECK(glm::distance(forest.point(vertex),
                        forest.point(a) + (forest.point(b) - forest.point(a)) / 3.0) < 1e-15);
}

TEST_CASE("A replayed forest is the same forest", "[forest]") {
    const BaseMesh mesh = grid();
    Forest forest(mesh);
    test::Random random(3);
    refine_at_random(forest, 3000, random);
    Forest again(mesh);
    again.replay(forest.history());
    REQUIRE(again.zone_count() == forest.zone_count());
    REQUIRE(again.patch_count() == forest.patch_count());
    REQUIRE(again.vertex_count() == forest.vertex_count());
    bool same = true;
    for (std::size_t v = 0; v < forest.vertex_count(); ++v)
        same = same && again.point(VertexId(v)) == forest.point(VertexId(v)) &&
               again.carrier(VertexId(v)) == forest.carrier(VertexId(v));
    for (std::size_t z = 0; z < forest.zone_count(); ++z) {
        const auto &a = again[ZoneId(z)], &b = forest[ZoneId(z)];
        same = same && a.corners == b.corners && a.first_child == b.first_child &&
               a.plane_normal == b.plane_normal && a.plane_offset == b.plane_offset;
    }
    for (std::size_t p = 0; p < forest.patch_count(); ++p) {
        const auto &a = again[PatchId(p)], &b = forest[PatchId(p)];
        same = same && a.corners == b.corners && a.first_child == b.first_child &&
               a.plane_normal == b.plane_normal && a.plane_offset == b.plane_offset;
    }
    CHECK(same);
}
