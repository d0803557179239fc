#include "mesh/convex_merge.h"
#include "support/catch.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <random>

using namespace tyndall::mesh;

namespace {

struct Soup {
    std::vector<Point> points;
    std::vector<std::array<VertexId, 3>> triangles;
};

// Cells of a grid in the plane through `origin` with axes u, v; those that `has` keeps.
Soup grid(const std::vector<double>& s, const std::vector<double>& t, Point origin, Direction u,
          Direction v, const std::function<bool(double, double)>& has) {
    Soup soup;
    for (double y : t)
        for (double x : s) soup.points.push_back(origin + x * u + y * v);
    const auto id = [&](std::size_t i, std::size_t j) { return VertexId(i + s.size() * j); };
    for (std::size_t j = 0; j + 1 < t.size(); ++j)
        for (std::size_t i = 0; i + 1 < s.size(); ++i) {
            if (!has(0.5 * (s[i] + s[i + 1]), 0.5 * (t[j] + t[j + 1]))) continue;
            soup.triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
            soup.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
        }
    return soup;
}

double corner_area(const std::vector<Point>& c) {
    Point sum(0);
    for (std::size_t k = 1; k + 1 < c.size(); ++k) sum += glm::cross(c[k] - c[0], c[k + 1] - c[0]);
    return 0.5 * glm::length(sum);
}

void check_convex(const ConvexPolygon& polygon) {
    const auto& c = polygon.corners;
    for (std::size_t k = 0; k < c.size(); ++k) {
        const Point &a = c[k], &b = c[(k + 1) % c.size()], &d = c[(k + 2) % c.size()];
        CHECK(glm::dot(glm::cross(b - a, d - b), polygon.normal) > 0.0);
    }
}

double total(const std::vector<ConvexPolygon>& polygons) {
    double sum = 0.0;
    for (const auto& p : polygons) {
        check_convex(p);
        sum += corner_area(p.corners);
    }
    return sum;
}

std::vector<double> steps(int n, double length) {
    std::vector<double> result;
    for (int k = 0; k <= n; ++k) result.push_back(length * k / n);
    return result;
}

const auto everywhere = [](double, double) { return true; };

}  // namespace

TEST_CASE("A divided rectangle becomes one polygon", "[convex_merge]") {
    const double tilt = GENERATE(0.0, 0.3, 1.1);
    const Direction u(std::cos(tilt), std::sin(tilt), 0), v(0, 0, 1);
    const auto soup = grid(steps(9, 3.0), steps(7, 2.0), {0.1, 0.2, 0.3}, u, v, everywhere);
    const auto merged = convex_merge(soup.points, soup.triangles, Facing::kept, 1e-11);
    REQUIRE(merged.size() == 1);
    CHECK(merged[0].corners.size() == 4);
    CHECK(total(merged) == Approx(6.0).epsilon(1e-13));
    CHECK(glm::distance(merged[0].normal, glm::cross(u, v)) < 1e-14);
}

TEST_CASE("A wall with six windows in a row becomes nine polygons", "[convex_merge]") {
    std::vector<double> s{0};
    for (int k = 0; k < 6; ++k) s.push_back(0.5 + k), s.push_back(1.0 + k);
    s.push_back(7.0);
    const auto soup = grid(
        s, {0, 1, 2, 3}, Point(0), {0.6, 0.8, 0}, {0, 0, 1},
        [](double x, double y) { return !(y > 1 && y < 2 && x < 6 && x - std::floor(x) > 0.5); });
    const auto merged = convex_merge(soup.points, soup.triangles, Facing::ignored, 1e-11);
    CHECK(total(merged) == Approx(21.0 - 6 * 0.5).epsilon(1e-13));
    CHECK(merged.size() == 9);
}

TEST_CASE("Sides are kept apart where asked, planes always", "[convex_merge]") {
    auto soup = grid({0, 1, 2}, {0, 1}, Point(0), {1, 0, 0}, {0, 1, 0}, everywhere);
    std::swap(soup.triangles[2][0], soup.triangles[2][1]);  // the second cell looks down
    std::swap(soup.triangles[3][0], soup.triangles[3][1]);
    CHECK(convex_merge(soup.points, soup.triangles, Facing::kept, 1e-11).size() == 2);
    CHECK(convex_merge(soup.points, soup.triangles, Facing::ignored, 1e-11).size() == 1);
    soup.points[2].z = soup.points[5].z = 1e-6;  // and is bent
    const auto bent = convex_merge(soup.points, soup.triangles, Facing::ignored, 1e-11);
    CHECK(bent.size() == 2);
    CHECK(total(bent) == Approx(2.0).epsilon(1e-11));
}

TEST_CASE("An L, a ring and two islands", "[convex_merge]") {
    const auto l = grid({0, 1, 2}, {0, 1, 2}, Point(0), {1, 0, 0}, {0, 1, 0},
                        [](double x, double y) { return x < 1 || y < 1; });
    auto merged = convex_merge(l.points, l.triangles, Facing::kept, 1e-11);
    CHECK(merged.size() == 2);
    CHECK(total(merged) == Approx(3.0));
    const auto ring = grid({0, 1, 2, 3}, {0, 1, 2, 3}, Point(0), {1, 0, 0}, {0, 1, 0},
                           [](double x, double y) { return !(x > 1 && x < 2 && y > 1 && y < 2); });
    merged = convex_merge(ring.points, ring.triangles, Facing::kept, 1e-11);
    CHECK(merged.size() == 4);
    CHECK(total(merged) == Approx(8.0));
    const auto islands = grid({0, 1, 2, 3}, {0, 1}, Point(0), {1, 0, 0}, {0, 1, 0},
                              [](double x, double) { return x < 1 || x > 2; });
    CHECK(convex_merge(islands.points, islands.triangles, Facing::kept, 1e-11).size() == 2);
}

TEST_CASE("A disc's triangles become one polygon", "[convex_merge]") {
    Soup soup;
    soup.points.push_back(Point(0));
    const int n = 48;
    for (int k = 0; k < n; ++k) {
        const double phi = 2 * M_PI * k / n;
        soup.points.push_back({std::cos(phi), std::sin(phi), 0});
        soup.triangles.push_back({VertexId(0), VertexId(1 + k), VertexId(1 + (k + 1) % n)});
    }
    const auto merged = convex_merge(soup.points, soup.triangles, Facing::kept, 1e-11);
    REQUIRE(merged.size() == 1);
    CHECK(merged[0].corners.size() == n);
}

// Corners on an edge square to the direction in which a hull sorts round to any order. Once, that
// lost corners, and light came through the wall.
TEST_CASE("No corner is lost to rounding", "[convex_merge]") {
    std::mt19937_64 random(17);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const std::vector<double> lines{0.0, 0.5, 1.0, 1.25, 1.5, 1.9, 2.0, 2.4, 3.0};
    for (int k = 0; k < 300; ++k) {
        const auto some = [&] { return Point(uniform(random), uniform(random), uniform(random)); };
        const Direction u = glm::normalize(some()), v = glm::normalize(glm::cross(u, some()));
        Soup wall = grid(lines, lines, 10.0 * some(), u, v, [](double x, double y) {
            return !(x > 1.0 && x < 2.0 && y > 1.0 && y < 2.0);
        });
        std::shuffle(wall.triangles.begin(), wall.triangles.end(), random);
        const auto polygons = convex_merge(wall.points, wall.triangles, Facing::ignored, 1e-10);
        CHECK(polygons.size() == 4);
        CHECK(total(polygons) == Approx(8.0).epsilon(1e-9));
    }
}
