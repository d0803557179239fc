#include "mesh/base_mesh.h"

#include <random>

#include "mesh/geometry.h"
#include "mesh/tetrahedralize.h"
#include "support/catch.h"

using namespace geometry;

namespace {

BaseMesh lit_mesh() {
    const auto scene = lit_room();
    return tetrahedralize(conform(scene), scene);
}

Point centroid(const BaseMesh& mesh, TetId tet) {
    Point sum(0.0);
    for (const auto i : mesh.tets[tet.value]) {
        sum += 0.25 * mesh.points[i.value];
    }
    return sum;
}

// Whether x is in the tet, but for rounding: no face sees it farther out than `slack` [m].
bool holds(const BaseMesh& mesh, TetId tet, Point x, double slack) {
    const auto& t = mesh.tets[tet.value];
    for (int k = 0; k < 4; ++k) {
        const auto a = mesh.points[t[(k + 1) % 4].value], b = mesh.points[t[(k + 2) % 4].value],
                   c = mesh.points[t[(k + 3) % 4].value];
        auto n = glm::normalize(glm::cross(b - a, c - a));
        n *= glm::dot(n, mesh.points[t[k].value] - a) > 0.0 ? 1.0 : -1.0;
        if (glm::dot(n, x - a) < -slack) {
            return false;
        }
    }
    return true;
}

}  // namespace

TEST_CASE("locate finds the tet of any point, from anywhere", "[base_mesh]") {
    const auto mesh = lit_mesh();
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    int lost = 0;
    for (int i = 0; i < 2000; ++i) {
        const Point x = mesh.hull_min + Point(uniform(random), uniform(random), uniform(random)) *
                                            (mesh.hull_max - mesh.hull_min);
        const TetId start(random() % mesh.tets.size());
        const auto tet = locate(mesh, x, start);
        lost += !tet.valid() || !holds(mesh, tet, x, 1e-12);
    }
    CHECK(lost == 0);
    for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
        lost += locate(mesh, centroid(mesh, TetId(t))) != TetId(t);
    }
    CHECK(lost == 0);
}

TEST_CASE("locate on corners, edges, faces and the hull", "[base_mesh]") {
    const auto mesh = lit_mesh();
    int lost = 0;
    for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
        const auto p = [&](int k) { return mesh.points[mesh.tets[t][k].value]; };
        for (const auto x : {p(0), 0.5 * (p(0) + p(1)), (p(0) + p(1) + p(2)) / 3.0}) {
            const auto tet = locate(mesh, glm::clamp(x, mesh.hull_min, mesh.hull_max));
            lost += !tet.valid() || !holds(mesh, tet, x, 1e-12);
        }
    }
    CHECK(lost == 0);
    CHECK(locate(mesh, mesh.hull_min).valid());
    CHECK(locate(mesh, mesh.hull_max).valid());
}

TEST_CASE("locate outside the hull finds nothing", "[base_mesh]") {
    const auto mesh = lit_mesh();
    CHECK_FALSE(locate(mesh, mesh.hull_max + Point(1e-9, 0, 0)).valid());
    CHECK_FALSE(locate(mesh, Point(1e30, 0, 0)).valid());
    CHECK_FALSE(locate(mesh, Point(0, std::nan(""), 0)).valid());
    CHECK_FALSE(locate(BaseMesh{}, Point(0.0)).valid());
}

TEST_CASE("regions: room, box and outside", "[base_mesh]") {
    const auto mesh = lit_mesh();
    const auto region = [&](Point x) { return mesh.regions[locate(mesh, x).value]; };
    const auto room = region({1, 1, 1}), box = region({2.3, 1.8, 0.4}),
               outside = region({-3, 0, 0});
    CHECK(room != box);
    CHECK(room != outside);
    CHECK(box != outside);
    CHECK(region({4.9, 3.9, 2.9}) == room);
    CHECK(region({-4.1, 2, 2.1}) == outside);
    std::vector<double> volumes(mesh.region_count, 0.0);
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        volumes[mesh.regions[t].value] += volume(mesh, TetId(t));
    }
    const double inside = 0.75 * 0.75 * 0.75;
    CHECK(volumes[box.value] == Approx(inside).epsilon(1e-12));  // a few hundred terms of doubles
    CHECK(volumes[room.value] == Approx(60.0 - inside).epsilon(1e-12));
}

TEST_CASE("area, normal and volume of one tet", "[base_mesh]") {
    BaseMesh mesh;
    mesh.points = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 4}};
    mesh.tets = {{VertexId(0), VertexId(1), VertexId(2), VertexId(3)}};
    mesh.facets = {{{VertexId(0), VertexId(1), VertexId(2)}, FacetId(), Opacity::opaque, {}}};
    CHECK(volume(mesh, TetId(0)) == 4.0);
    CHECK(area(mesh, FacetId(0)) == 3.0);
    CHECK(normal(mesh, FacetId(0)) == Direction(0, 0, 1));
}
