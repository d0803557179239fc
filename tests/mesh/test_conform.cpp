#include "mesh/conform.h"

#include <chrono>
#include <random>

#include "mesh/conform_exact.h"
#include "mesh/geometry.h"
#include "mesh/input_error.h"
#include "mesh/tetrahedralize.h"
#include "support/catch.h"

using namespace geometry;
using Catch::Matchers::Contains;

namespace {

// Areas are sums of a few hundred products of coordinates of some metres: 1e-10 leaves room for all
// their rounding and none for a wrong triangle.
constexpr double rounding = 1e-10;

// Every polygon is covered once by its facets, no two facets cross, and TetGen takes the result.
ConformingComplex conform_and_check(const Polygons& scene, double relative = rounding) {
    auto complex = conform(scene);
    const auto areas = areas_by_polygon(complex, scene.size());
    for (std::size_t p = 0; p < scene.size(); ++p) {
        INFO("polygon " << p << " " << scene[p].name);
        CHECK(areas[p] == Approx(area_of(scene[p].corners)).epsilon(relative));
    }
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (const auto& facet : complex.facets) {
        triangles.push_back(
            {facet.corners[0].value, facet.corners[1].value, facet.corners[2].value});
    }
    CHECK(conforming::crossing_pairs(complex.points, triangles).empty());
    CHECK(tetrahedralize(complex, scene).tets.size() > 0);
    return complex;
}

// Rotation by angle about axis (Rodrigues).
glm::dvec3 rotate(glm::dvec3 x, glm::dvec3 axis, double angle) {
    axis = glm::normalize(axis);
    return std::cos(angle) * x + std::sin(angle) * glm::cross(axis, x) +
           (1.0 - std::cos(angle)) * glm::dot(axis, x) * axis;
}

Polygons rotated(Polygons scene, glm::dvec3 axis, double angle) {
    for (auto& p : scene) {
        for (auto& corner : p.corners) {
            corner = rotate(corner, axis, angle);
        }
    }
    return scene;
}

void check_owned(const ConformingComplex& complex, std::size_t polygon, double front, double back) {
    INFO("polygon " << polygon);
    const auto areas = owned(complex, polygon);
    CHECK(areas[0] == Approx(front).epsilon(rounding).margin(rounding));
    CHECK(areas[1] == Approx(back).epsilon(rounding).margin(rounding));
}

}  // namespace

TEST_CASE("a lone polygon keeps its area and owns both sides", "[conform]") {
    const Polygons scene{sheet({0, 0, 0}, {2, 0, 0}, {0, 3, 0}, "sheet")};
    const auto complex = conform_and_check(scene);
    CHECK(complex.facets.size() == 2);
    check_owned(complex, 0, 6.0, 6.0);
    for (const auto& facet : complex.facets) {
        const auto& p = complex.points;
        const auto n = glm::cross(p[facet.corners[1].value] - p[facet.corners[0].value],
                                  p[facet.corners[2].value] - p[facet.corners[0].value]);
        CHECK(n.z > 0.0);
        CHECK(facet.front.side == Side::front);
        CHECK(facet.back.side == Side::back);
    }
}

TEST_CASE("a lit room: window, box on the floor, lamp outside", "[conform]") {
    const auto scene = lit_room();
    const auto complex = conform_and_check(scene);
    for (std::size_t p = 6; p < 12; ++p) {  // windows lie on the opaque wall: no opening there
        check_owned(complex, p, 0.0, 0.0);
    }
    for (const auto& facet : complex.facets) {
        CHECK(facet.opacity == Opacity::opaque);
    }
    // The box's bottom looks down: its front owns the floor's back there, and the floor keeps its
    // front.
    check_owned(complex, 0, 20.0, 20.0 - 0.75 * 0.75);
    check_owned(complex, 12, 0.75 * 0.75, 0.0);
}

TEST_CASE("an opening in a wall that leaves room for it is an interface", "[conform]") {
    // A frame of four sheets around an opening.
    const Polygons scene{sheet({0, 0, 0}, {3, 0, 0}, {0, 0, 1}, "wall"),
                         sheet({0, 0, 2}, {3, 0, 0}, {0, 0, 1}, "wall"),
                         sheet({0, 0, 1}, {1, 0, 0}, {0, 0, 1}, "wall"),
                         sheet({2, 0, 1}, {1, 0, 0}, {0, 0, 1}, "wall"),
                         sheet({1, 0, 1}, {1, 0, 0}, {0, 0, 1}, "door", Opacity::interface)};
    const auto complex = conform_and_check(scene);
    double open = 0.0;
    for (const auto& facet : complex.facets) {
        if (facet.opacity == Opacity::interface) {
            open += area_of(complex, facet);
            CHECK_FALSE(facet.front.polygon.valid());
            CHECK_FALSE(facet.back.polygon.valid());
        }
    }
    CHECK(open == Approx(1.0).epsilon(rounding));
}

TEST_CASE("an emitter in the ceiling's plane owns the side it faces", "[conform]") {
    Polygons scene;
    add_room(scene, {0, 0, 0}, {4, 3, 3}, "room");
    REQUIRE(scene[1].corners[0].z == 3.0);
    scene.push_back(sheet({1, 1, 3}, {0, 1, 0}, {1, 0, 0}, "lamp"));  // looks down, as the ceiling
    const auto complex = conform_and_check(scene);
    check_owned(complex, 1, 11.0, 12.0);
    check_owned(complex, 6, 1.0, 0.0);
    SECTION("looking up, it owns the side away from the room") {
        scene.back() = sheet({1, 1, 3}, {1, 0, 0}, {0, 1, 0}, "lamp");
        const auto up = conform_and_check(scene);
        check_owned(up, 1, 12.0, 11.0);
        check_owned(up, 6, 1.0, 0.0);
    }
}

TEST_CASE("a box partly over another box's face", "[conform]") {
    Polygons scene;
    add_box(scene, {0, 0, 0}, {1, 1, 1}, "lower");
    add_box(scene, {0.5, 0.25, 1}, {1.5, 0.75, 2}, "upper");
    const auto complex = conform_and_check(scene);
    // lower.top looks up into upper.bottom, which looks down: the upper one takes the side below.
    check_owned(complex, 1, 1.0, 0.75);
    check_owned(complex, 6, 0.5, 0.25);
}

TEST_CASE("crossing shelves", "[conform]") {
    const Polygons scene{sheet({0, 0, 0.5}, {2, 0, 0}, {0, 2, 0}, "level"),
                         sheet({0.7, 0, 0}, {0, 2, 0}, {0, 0, 1}, "upright"),
                         sheet({0, 1.1, 0}, {2, 0, 0}, {0, 0, 1}, "back"),
                         sheet({0, 0, 0}, {2, 0, 1}, {0, 2, 0}, "slope")};
    const auto turned = GENERATE(false, true);
    conform_and_check(turned ? rotated(scene, {1, 2, 3}, 0.7) : scene);
}

TEST_CASE("a partition meets walls, floor and ceiling in T-junctions", "[conform]") {
    Polygons scene;
    add_room(scene, {0, 0, 0}, {4, 3, 3}, "room");
    scene.push_back(sheet({2, 0, 0}, {0, 1.4, 0}, {0, 0, 3}, "partition"));
    scene.push_back(sheet({2, 1.6, 0}, {0, 1.4, 0}, {0, 0, 3}, "partition"));
    scene.push_back(sheet({2, 1.4, 2.5}, {0, 0.2, 0}, {0, 0, 0.5}, "lintel"));
    const auto angle = GENERATE(0.0, 0.3, 1.1);
    conform_and_check(rotated(scene, {3, -1, 2}, angle));
}

TEST_CASE("the same polygon twice, then reversed", "[conform]") {
    const auto sheet_up = sheet({0, 0, 0}, {2, 0, 0}, {0, 3, 0}, "first");
    const auto sheet_down = sheet({0, 0, 0}, {0, 3, 0}, {2, 0, 0}, "second");
    SECTION("twice") {
        const auto complex = conform_and_check({sheet_up, sheet_up});
        CHECK(complex.facets.size() == 2);
        check_owned(complex, 0, 0.0, 6.0);
        check_owned(complex, 1, 6.0, 0.0);
    }
    SECTION("reversed") {
        const auto complex = conform_and_check({sheet_up, sheet_down});
        check_owned(complex, 0, 6.0, 0.0);
        check_owned(complex, 1, 6.0, 0.0);
    }
    SECTION("three of them") {
        const auto complex = conform_and_check({sheet_up, sheet_down, sheet_up});
        check_owned(complex, 0, 0.0, 0.0);
        check_owned(complex, 1, 6.0, 0.0);
        check_owned(complex, 2, 6.0, 0.0);
    }
}

TEST_CASE("an opaque polygon on an interface closes it", "[conform]") {
    const auto window = sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, "window", Opacity::interface);
    const auto board = sheet({0, 0, 0}, {0, 0.5, 0}, {1, 0, 0}, "board");
    for (const auto& scene : {Polygons{window, board}, Polygons{board, window}}) {
        const auto complex = conform_and_check(scene);
        double closed = 0.0;
        for (const auto& facet : complex.facets) {
            closed += facet.opacity == Opacity::opaque ? area_of(complex, facet) : 0.0;
        }
        CHECK(closed == Approx(0.5).epsilon(rounding));
        check_owned(complex, scene[0].name == "board" ? 0 : 1, 0.5, 0.5);
    }
}

TEST_CASE("planes within the tolerance are one", "[conform]") {
    Polygons scene;
    add_room(scene, {0, 0, 0}, {4, 3, 3}, "room");
    const double off = GENERATE(1e-9, -1e-9, 2e-7);  // the tolerance is 1e-7 of 5.8 m
    scene.push_back(sheet({1, 1, 3 + off}, {0, 1, 0}, {1, 0, 0}, "lamp"));
    scene.push_back(sheet({1, 1, off}, {1, 0, 0}, {0, 1, 2e-7}, "mat"));
    const auto complex = conform_and_check(scene, 1e-6);  // moved by 1e-7 of lengths of a metre
    check_owned(complex, 1, 11.0, 12.0);
    check_owned(complex, 6, 1.0, 0.0);
    check_owned(complex, 7, 1.0, 0.0);
}

TEST_CASE("polygons: not convex, collinear and repeated corners, a slit to a hole", "[conform]") {
    const auto ell =
        polygon({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}, "ell");
    const auto dotted = polygon(
        {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 0, 0}},
        "dotted");
    const auto frame = polygon({{0, 0, 0},
                                {3, 0, 0},
                                {3, 3, 0},
                                {0, 3, 0},
                                {0, 0, 0},
                                {1, 1, 0},
                                {1, 2, 0},
                                {2, 2, 0},
                                {2, 1, 0},
                                {1, 1, 0}},
                               "frame");
    CHECK(areas_by_polygon(conform_and_check({ell}), 1)[0] == Approx(3.0).epsilon(rounding));
    CHECK(areas_by_polygon(conform_and_check({dotted}), 1)[0] == Approx(4.0).epsilon(rounding));
    const Polygons framed{frame,
                          sheet({1, 1, 0}, {1, 0, 0}, {0, 1, 0}, "hole", Opacity::interface)};
    const auto complex = conform_and_check(rotated(framed, {1, 1, 1}, 0.4));
    check_owned(complex, 0, 8.0, 8.0);
}

TEST_CASE("many polygons on one plane, edges crossing edges", "[conform]") {
    Polygons scene{sheet({-1, -1, 0}, {5, 0, 0}, {0, 5, 0}, "floor")};
    for (int i = 0; i < 8; ++i) {
        const double a = 0.4 * i;
        scene.push_back(sheet({1.5 - std::cos(a), 1.5 - std::sin(a), 0},
                              {2 * std::cos(a), 2 * std::sin(a), 0},
                              {-0.3 * std::sin(a), 0.3 * std::cos(a), 0}, "strip"));
    }
    const auto angle = GENERATE(0.0, 0.9);
    conform_and_check(rotated(scene, {2, 1, 0.3}, angle));
}

TEST_CASE("64 rotated boxes on a floor, some in one another", "[conform]") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    Polygons scene;
    add_room(scene, {-1, -1, 0}, {9, 9, 4}, "room");
    for (int i = 0; i < 64; ++i) {
        const double a = 6.28 * uniform(random), size = 0.4 + 0.7 * uniform(random);
        const glm::dvec3 u(size * std::cos(a), size * std::sin(a), 0),
            v(-size * std::sin(a), size * std::cos(a), 0), w(0, 0, 0.3 + uniform(random));
        add_block(scene, {0.5 + i % 8, 0.5 + i / 8, 0}, u, v, w, "box");
    }
    const auto tilted = GENERATE(false, true);
    conform_and_check(tilted ? rotated(scene, {1, 2, 3}, 0.7) : scene);
}

TEST_CASE("64 boxes in any orientation", "[conform]") {
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    Polygons scene;
    add_room(scene, {-1, -1, -1}, {5, 5, 5}, "room");
    for (int i = 0; i < 64; ++i) {
        const auto axis = glm::dvec3(normal(random), normal(random), normal(random));
        const double angle = 3.0 * normal(random);
        const auto turn = [&](glm::dvec3 x) { return rotate(0.9 * x, axis, angle); };
        add_block(scene, {0.5 + i % 4, 0.5 + i / 4 % 4, 0.5 + i / 16}, turn({1, 0, 0}),
                  turn({0, 1, 0}), turn({0, 0, 1}), "box");
    }
    conform_and_check(scene);
}

TEST_CASE("corners a billionth apart are one", "[conform]") {
    Polygons scene;
    add_room(scene, {0, 0, 0}, {4, 3, 3}, "room");
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1e-9, 1e-9);
    add_box(scene, {1, 1, 0}, {2, 2, 1}, "box");
    add_box(scene, {2, 1, 0}, {3, 2, 1}, "box");
    for (auto& p : scene) {
        for (auto& corner : p.corners) {
            corner += glm::dvec3(uniform(random), uniform(random), uniform(random));
        }
    }
    const auto complex = conform_and_check(scene, 1e-8);  // moved by 1e-9 of a metre
    CHECK(complex.points.size() == 8 + 12);
}

TEST_CASE("a gap of 1e-5 m between two plates stays open", "[conform]") {
    const Polygons scene{sheet({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, "lower"),
                         sheet({0.5, 0.5, 1e-5}, {2, 0, 0}, {0, 2, 0}, "upper")};
    const auto complex = conform_and_check(scene);
    CHECK(complex.points.size() == 8);
}

TEST_CASE("a quad of single precision, warped beyond the tolerance, is still one", "[conform]") {
    Polygons scene{sheet({0, 0, 0}, {3, 0, 0}, {0, 3, 0}, "floor")};
    scene.push_back(polygon({{1, 1, 1}, {2, 1, 1}, {2, 2, 1 + 5e-6}, {1, 2, 1}}, "warped"));
    conform_and_check(scene, 1e-9);  // its area changes by the square of the warp
}

TEST_CASE("sheets that cross at almost no angle", "[conform]") {
    const double slope = std::pow(10.0, GENERATE(-3, -4, -5, -6, -7, -8));
    const Polygons scene{
        sheet({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, "level"),
        sheet({0.3, 0.4, -slope}, {2, 0, 2 * slope}, {0.1, 2, 0.3 * slope}, "slant")};
    // Where they merge, a point moves by up to 256 times the tolerance, along edges of 8 m in all.
    const auto complex = conform(scene);
    const auto areas = areas_by_polygon(complex, 2);
    CHECK(areas[0] == Approx(4.0).margin(8.0 * 2.56e-5 * 3.6));
    CHECK(areas[1] == Approx(area_of(scene[1].corners)).margin(8.0 * 2.56e-5 * 3.6));
}

TEST_CASE("what cannot be conformed says why", "[conform]") {
    const auto bad = [](std::vector<Point> corners) {
        return Polygons{sheet({0, 0, 0}, {3, 0, 0}, {0, 3, 0}, "floor"),
                        polygon(std::move(corners), "culprit")};
    };
    const double nan = std::nan("");
    CHECK_THROWS_WITH(conform(bad({{0, 0, 1}, {1, 0, 1}})),
                      Contains("culprit") && Contains("2 corners"));
    CHECK_THROWS_WITH(conform(bad({{0, 0, 1}, {1, nan, 1}, {1, 1, 1}})),
                      Contains("culprit") && Contains("finite"));
    CHECK_THROWS_WITH(conform(bad({{0, 0, 1}, {1, 0, 1}, {1, 1, 1.1}, {0, 1, 1}})),
                      Contains("culprit") && Contains("planar"));
    CHECK_THROWS_WITH(conform(bad({{0, 0, 1}, {1, 1, 1}, {1, 0, 1}, {0, 1, 1}})),
                      Contains("culprit") && Contains("crosses itself"));
    CHECK_THROWS_WITH(conform(bad({{0, 0, 1}, {1, 1, 1}, {1, 0, 1}, {0, 2, 1}})),
                      Contains("culprit") && Contains("crosses itself"));
    CHECK_THROWS_WITH(conform(bad({{0, 0, 1}, {1, 1, 1}, {2, 2, 1}})),
                      Contains("culprit") && Contains("no area"));
    CHECK_THROWS_WITH(conform(bad({{0, 0, 1}, {0, 0, 1}, {1, 0, 1}, {1, 0, 1}})),
                      Contains("culprit") && Contains("no area"));
    CHECK_THROWS_WITH(
        conform(bad({{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}})),
        Contains("culprit") && Contains("overlaps itself"));
    CHECK_THROWS_AS(conform(bad({{0, 0, 1}, {1e200, 0, 1}, {1, 1e200, 1}})), InputError);
}

TEST_CASE("the order of equal input decides nothing else: same result twice", "[conform]") {
    const auto scene = lit_room();
    const auto a = conform(scene), b = conform(scene);
    REQUIRE(a.points == b.points);
    REQUIRE(a.facets.size() == b.facets.size());
    for (std::size_t f = 0; f < a.facets.size(); ++f) {
        CHECK(a.facets[f].corners == b.facets[f].corners);
    }
}
