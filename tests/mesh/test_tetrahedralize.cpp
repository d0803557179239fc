#include "mesh/tetrahedralize.h"

#include <chrono>
#include <filesystem>
#include <map>
#include <set>

#include "mesh/geometry.h"
#include "mesh/input_error.h"
#include "mesh/tetgen_process.h"
#include "support/catch.h"

using namespace geometry;
using Catch::Matchers::Contains;

namespace {

// Sums of up to 1e5 terms of double precision.
constexpr double tet_rounding = 1e-10;

void check_topology(const BaseMesh& mesh) {
    bool mutual = true, shared = true, same_facet = true;
    for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
        for (int k = 0; k < 4; ++k) {
            const auto n = mesh.neighbours[t][k];
            if (!n.valid()) {
                continue;
            }
            const auto& back = mesh.neighbours[n.value];
            const auto j = std::find(back.begin(), back.end(), TetId(t)) - back.begin();
            mutual = mutual && j < 4;
            if (j == 4) {
                continue;
            }
            std::set<VertexId> mine(mesh.tets[t].begin(), mesh.tets[t].end());
            std::set<VertexId> theirs(mesh.tets[n.value].begin(), mesh.tets[n.value].end());
            mine.erase(mesh.tets[t][k]);
            theirs.erase(mesh.tets[n.value][j]);
            shared = shared && mine == theirs;
            same_facet = same_facet && mesh.tet_facets[t][k] == mesh.tet_facets[n.value][j];
        }
    }
    CHECK(mutual);
    CHECK(shared);
    CHECK(same_facet);
}

void check_volume(const BaseMesh& mesh) {
    double total = 0.0, least = INFINITY;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        total += volume(mesh, TetId(t));
        least = std::min(least, volume(mesh, TetId(t)));
    }
    const auto e = mesh.hull_max - mesh.hull_min;
    CHECK(total == Approx(e.x * e.y * e.z).epsilon(tet_rounding));
    CHECK(least > 0.0);
}

// Facets look as their sources do, have the tets on the right sides, and fill them.
void check_facets(const BaseMesh& mesh, const ConformingComplex& complex) {
    std::map<std::vector<PolygonId>, double> wanted, found;
    for (const auto& facet : complex.facets) {
        wanted[facet.polygons] += area_of(complex, facet);
    }
    int wrong = 0;
    for (std::uint32_t f = 0; f < mesh.facets.size(); ++f) {
        const auto& facet = mesh.facets[f];
        const auto& source = complex.facets[facet.source.value];
        found[source.polygons] += area(mesh, FacetId(f));
        const auto& p = complex.points;
        const auto n = glm::cross(p[source.corners[1].value] - p[source.corners[0].value],
                                  p[source.corners[2].value] - p[source.corners[0].value]);
        wrong += glm::dot(n, normal(mesh, FacetId(f))) <= 0.0;
        wrong += facet.opacity != source.opacity;
        for (const int side : {0, 1}) {
            const auto tet = facet.tets[side];
            if (!tet.valid()) {
                ++wrong;
                continue;
            }
            Point centroid(0.0);
            for (const auto i : mesh.tets[tet.value]) {
                centroid += 0.25 * mesh.points[i.value];
            }
            const double above =
                glm::dot(centroid - mesh.points[facet.corners[0].value], normal(mesh, FacetId(f)));
            wrong += side == 0 ? above <= 0.0 : above >= 0.0;
            const auto& around = mesh.tet_facets[tet.value];
            wrong += std::count(around.begin(), around.end(), FacetId(f)) != 1;
        }
    }
    CHECK(wrong == 0);
    REQUIRE(found.size() == wanted.size());
    for (const auto& [polygons, area] : wanted) {
        CHECK(found[polygons] == Approx(area).epsilon(tet_rounding));
    }
}

BaseMesh mesh_and_check(const Polygons& scene) {
    const auto complex = conform(scene);
    auto mesh = tetrahedralize(complex, scene);
    check_topology(mesh);
    check_volume(mesh);
    check_facets(mesh, complex);
    return mesh;
}

// A sphere of triangles: an icosahedron, each triangle quartered `levels` times.
void add_sphere(Polygons& to, Point centre, double radius, int levels) {
    const double g = 0.5 * (1.0 + std::sqrt(5.0));
    const std::vector<Point> corners{{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                     {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                     {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    const int faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                              {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                              {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                              {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    std::vector<std::array<Point, 3>> triangles;
    for (const auto& face : faces) {
        triangles.push_back({glm::normalize(corners[face[0]]), glm::normalize(corners[face[1]]),
                             glm::normalize(corners[face[2]])});
    }
    for (int level = 0; level < levels; ++level) {
        std::vector<std::array<Point, 3>> finer;
        for (const auto& [a, b, c] : triangles) {
            const auto ab = glm::normalize(a + b), bc = glm::normalize(b + c),
                       ca = glm::normalize(c + a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        triangles = std::move(finer);
    }
    for (const auto& [a, b, c] : triangles) {
        to.push_back(
            polygon({centre + radius * a, centre + radius * b, centre + radius * c}, "sphere"));
    }
}

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Facets as they come, not conformed: what TetGen must never see from us.
ConformingComplex as_it_is(const Polygons& scene) {
    ConformingComplex complex;
    for (std::size_t p = 0; p < scene.size(); ++p) {
        const auto& corners = scene[p].corners;
        const auto first = complex.points.size();
        complex.points.insert(complex.points.end(), corners.begin(), corners.end());
        for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
            ConformingFacet facet;
            facet.corners = {VertexId(first), VertexId(first + k), VertexId(first + k + 1)};
            facet.polygons = {PolygonId(p)};
            complex.facets.push_back(facet);
        }
    }
    return complex;
}

}  // namespace

TEST_CASE("a lit room becomes a coarse mesh", "[tetrahedralize]") {
    const auto mesh = mesh_and_check(lit_room());
    CHECK(mesh.region_count == 3);   // the room, the inside of the box, what lies outside
    CHECK(mesh.tets.size() < 3000);  // coarse: refinement is not TetGen's task
}

TEST_CASE("interfaces are facets too", "[tetrahedralize]") {
    const Polygons scene{sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, "lid", Opacity::interface),
                         sheet({1, 0, 0}, {1, 0, 0}, {0, 1, 0}, "plate")};
    const auto mesh = mesh_and_check(scene);
    CHECK(mesh.region_count == 1);
    double open = 0.0;
    for (std::uint32_t f = 0; f < mesh.facets.size(); ++f) {
        open += mesh.facets[f].opacity == Opacity::interface ? area(mesh, FacetId(f)) : 0.0;
    }
    CHECK(open == Approx(1.0).epsilon(tet_rounding));
}

TEST_CASE("a room split in two by a partition has three regions", "[tetrahedralize]") {
    Polygons scene;
    add_room(scene, {0, 0, 0}, {4, 3, 3}, "room");
    scene.push_back(sheet({2, 0, 0}, {0, 3, 0}, {0, 0, 3}, "partition"));
    CHECK(mesh_and_check(scene).region_count == 3);
}

TEST_CASE("a panel that floats in a room on round coordinates, alone and twice",
          "[tetrahedralize]") {
    // TetGen 1.5.0 fails an assertion on this one, whatever the switches, until it is turned.
    Polygons scene;
    add_room(scene, {0, 0, 0}, {4, 3, 3}, "room");
    scene.push_back(sheet({1, 1, 1}, {1, 0, 0}, {0, 1, 0}, "panel"));
    CHECK(mesh_and_check(scene).region_count == 2);
    scene.push_back(sheet({1, 1, 1}, {1, 0, 0}, {0, 1, 0}, "panel again"));
    CHECK(mesh_and_check(scene).region_count == 2);
}

TEST_CASE("a sphere of 5 k triangles in a room, whole and through its walls", "[tetrahedralize]") {
    const double radius = GENERATE(1.0, 1.8);
    Polygons scene;
    add_room(scene, {0, 0, 0}, {5, 4, 3}, "room");
    add_sphere(scene, {2.5, 2, 1.5}, radius, 4);
    const auto mesh = mesh_and_check(scene);
    // Through floor and ceiling: outside falls apart into room, sphere in the room, two caps,
    // outside.
    CHECK(mesh.region_count == (radius < 1.5 ? 3 : 5));
}

TEST_CASE("two plates 1e-5 m apart", "[tetrahedralize]") {
    const Polygons scene{sheet({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, "lower"),
                         sheet({0.5, 0.5, 1e-5}, {2, 0, 0}, {0, 2, 0}, "upper")};
    const auto start = std::chrono::steady_clock::now();
    CHECK(mesh_and_check(scene).tets.size() < 10000);
    CHECK(seconds_since(start) < 20.0);
}

TEST_CASE("the same mesh every time", "[tetrahedralize]") {
    const auto scene = lit_room();
    const auto complex = conform(scene);
    const auto a = tetrahedralize(complex, scene), b = tetrahedralize(complex, scene);
    CHECK(a.points == b.points);
    CHECK(a.tets == b.tets);
    CHECK(a.facets.size() == b.facets.size());
}

TEST_CASE("a complex that is none is refused by name and place", "[tetrahedralize]") {
    const auto floor = sheet({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, "floor");
    const auto refused = [](const Polygons& scene) {
        const auto start = std::chrono::steady_clock::now();
        CHECK_THROWS_WITH(tetrahedralize(as_it_is(scene), scene),
                          Contains("floor") && Contains("culprit") && Contains("near ("));
        CHECK(seconds_since(start) < 20.0);
    };
    refused({floor, sheet({0.5, 0.5, -1}, {1, 0, 0}, {0, 0.2, 2}, "culprit")});
    refused({floor, sheet({0.5, 0.5, 0}, {1, 0, 0}, {0, 0.2, 0}, "culprit")});
    refused({floor, sheet({0.5, 0.5, 0}, {1, 0, 0}, {0, 0, 1}, "culprit")});
}

TEST_CASE("every way for the worker to fail is an error of its own", "[tetrahedralize]") {
    const auto scene = lit_room();
    const auto complex = conform(scene);
    const auto fails = [&](const TetrahedralizeOptions& options, const std::string& with) {
        const auto start = std::chrono::steady_clock::now();
        CHECK_THROWS_AS(tetrahedralize(complex, scene, options), InputError);
        CHECK_THROWS_WITH(tetrahedralize(complex, scene, options), Contains(with));
        CHECK(seconds_since(start) < 10.0);
    };
    TetrahedralizeOptions options;
    SECTION("missing") {
        options.worker = "/nowhere/tyndall-tetgen";
        fails(options, "/nowhere/tyndall-tetgen");
    }
    SECTION("another program") {
        options.worker = "/bin/true";
        fails(options, "cut short");
        options.worker = "/bin/false";
        fails(options, "code 1");
    }
    SECTION("memory") {
        options.max_bytes = GENERATE(std::size_t(1) << 16, std::size_t(1) << 20);
        fails(options, "memory");
    }
    SECTION("time") {
        options.max_seconds = 1e-5;
        fails(options, "Allow more time");
    }
    SECTION("margin") {
        options.hull_margin = GENERATE(0.0, -1.0, std::nan(""));
        fails(options, "margin");
    }
    SECTION("limits that make no sense") {
        options.max_seconds = GENERATE(0.0, std::nan(""));
        fails(options, "time limit");
    }
}

TEST_CASE("nothing to mesh", "[tetrahedralize]") {
    CHECK_THROWS_AS(tetrahedralize({}, {}), InputError);
}

TEST_CASE("the worker is beside the running program", "[tetrahedralize]") {
    CHECK(tetgen::find_worker({}).filename() == "tyndall-tetgen");
}
