#include "mesh/fans.h"

#include <set>

#include "support/box_mesh.h"
#include "support/catch.h"

using namespace tyndall;
using namespace tyndall::mesh;

namespace {

// A 2 × 2 × 2 grid in a box. A partition in the plane x = 1 up to z = 1, and a floor all over.
BaseMesh partitioned(Opacity opacity = Opacity::opaque) {
    return test::box_enclosure({{{0, 1, 2}, {0, 1, 2}, {0, 1, 2}}},
                               [=](Point c, int axis) -> std::optional<test::Face> {
                                   if (axis == 0 && c.x == 1.0 && c.z < 1.0)
                                       return test::Face{opacity};
                                   if (c[axis] == 0.0 || c[axis] == 2.0) return test::Face{};
                                   return std::nullopt;
                               })
        .mesh;
}

Point middle_of(const BaseMesh& mesh, TetId tet) {
    Point sum(0.0);
    for (const VertexId v : mesh.tets[tet.value]) sum += 0.25 * mesh.points[v.value];
    return sum;
}

VertexId vertex_at(const BaseMesh& mesh, Point x) {
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
        if (mesh.points[v] == x) return VertexId(v);
    return {};
}

// Fans of the tets around a vertex, by left (x < 1) and right of the partition.
std::array<std::set<TetId>, 2> fans_around(const BaseMesh& mesh, VertexId v) {
    Fans fans(mesh);
    const Carrier carrier{v, {}, {}, {}};
    std::array<std::set<TetId>, 2> result;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        const auto& c = mesh.tets[t];
        if (std::find(c.begin(), c.end(), v) == c.end()) continue;
        result[middle_of(mesh, TetId(t)).x > 1.0].insert(fans.of_tet(carrier, TetId(t)));
    }
    return result;
}

std::uint32_t side_looking(const BaseMesh& mesh, FacetId facet, Direction n) {
    return 2 * facet.value + (glm::dot(normal(mesh, facet), n) > 0.0 ? 0 : 1);
}

Point middle(const BaseMesh& mesh, const BaseFacet& f) {
    return (mesh.points[f.corners[0].value] + mesh.points[f.corners[1].value] +
            mesh.points[f.corners[2].value]) /
           3.0;
}

}  // namespace

TEST_CASE("A partition's two sides are two fans", "[fans]") {
    const BaseMesh mesh = partitioned();
    // At the partition's foot, in its middle height the vertex lies on its upper edge.
    const auto foot = fans_around(mesh, vertex_at(mesh, {1, 1, 0}));
    CHECK(foot[0].size() == 1);
    CHECK(foot[1].size() == 1);
    CHECK(foot[0] != foot[1]);
    // Over the partition's upper edge one goes from side to side.
    const auto top = fans_around(mesh, vertex_at(mesh, {1, 1, 1}));
    CHECK(top[0].size() == 1);
    CHECK(top[0] == top[1]);
}

TEST_CASE("An interface does not part a fan", "[fans]") {
    const BaseMesh mesh = partitioned(Opacity::interface);
    const auto foot = fans_around(mesh, vertex_at(mesh, {1, 1, 0}));
    CHECK(foot[0].size() == 1);
    CHECK(foot[0] == foot[1]);
}

TEST_CASE("Facet sides join where the surface goes on flat", "[fans]") {
    const BaseMesh mesh = partitioned();
    Fans fans(mesh);
    const auto fans_on = [&](VertexId v, int axis, double at, Direction n, auto&& keep) {
        std::set<std::uint32_t> result;
        for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
            const auto& facet = mesh.facets[f];
            const Point m = middle(mesh, facet);
            if (std::abs(m[axis] - at) > 1e-12 || !keep(m)) continue;
            if (std::find(facet.corners.begin(), facet.corners.end(), v) == facet.corners.end())
                continue;
            result.insert(fans.of_facet_side({v, {}, {}, {}}, side_looking(mesh, FacetId(f), n)));
        }
        return result;
    };
    const auto all = [](Point) { return true; };
    const auto left = [](Point m) { return m.x < 1.0; };
    const auto right = [](Point m) { return m.x > 1.0; };
    // The ceiling's middle: nothing stands there.
    CHECK(fans_on(vertex_at(mesh, {1, 1, 2}), 2, 2.0, {0, 0, -1}, all).size() == 1);
    // The floor's middle: the partition stands on it.
    const VertexId foot = vertex_at(mesh, {1, 1, 0});
    const auto floor_left = fans_on(foot, 2, 0.0, {0, 0, 1}, left);
    const auto floor_right = fans_on(foot, 2, 0.0, {0, 0, 1}, right);
    CHECK(floor_left.size() == 1);
    CHECK(floor_right.size() == 1);
    CHECK(floor_left != floor_right);
    // The partition itself: one fan a side, floor and partition do not join.
    const auto front = fans_on(foot, 0, 1.0, {1, 0, 0}, all);
    const auto back = fans_on(foot, 0, 1.0, {-1, 0, 0}, all);
    CHECK(front.size() == 1);
    CHECK(back.size() == 1);
    CHECK(front != back);
    CHECK(front != floor_right);
    // The outer side of the floor is another than its inner side.
    CHECK(fans_on(foot, 2, 0.0, {0, 0, -1}, left) != floor_left);
}

TEST_CASE("A vertex on an edge or a face has the fan of that edge or face", "[fans]") {
    const BaseMesh mesh = partitioned();
    Forest forest(mesh);
    Fans fans(mesh);
    // The middle of the partition's foot.
    const VertexId v =
        forest.vertex_on_edge(vertex_at(mesh, {1, 0, 0}), vertex_at(mesh, {1, 1, 0}));
    std::array<std::set<TetId>, 2> sides;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        const auto& c = mesh.tets[t];
        const auto& carrier = forest.carrier(v);
        if (std::find(c.begin(), c.end(), carrier[0]) == c.end() ||
            std::find(c.begin(), c.end(), carrier[1]) == c.end())
            continue;
        sides[middle_of(mesh, TetId(t)).x > 1.0].insert(fans.of_tet(carrier, TetId(t)));
    }
    CHECK(sides[0].size() == 1);
    CHECK(sides[1].size() == 1);
    CHECK(sides[0] != sides[1]);
}
