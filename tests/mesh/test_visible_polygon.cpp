#include "mesh/visible_polygon.h"
#include "support/catch.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

using namespace tyndall::mesh;

namespace {

using Rng = std::mt19937_64;

double uniform(Rng& rng, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(rng);
}

Point in_box(Rng& rng, Point low, Point high) {
    return {uniform(rng, low.x, high.x), uniform(rng, low.y, high.y), uniform(rng, low.z, high.z)};
}

ConvexPolygon polygon(std::vector<Point> corners) {
    const auto n = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    return {std::move(corners), n};
}

double area(std::span<const Point> corners) {
    Point sum(0);
    for (std::size_t k = 1; k + 1 < corners.size(); ++k)
        sum += glm::cross(corners[k] - corners[0], corners[k + 1] - corners[0]);
    return 0.5 * glm::length(sum);
}

double area(const ConvexParts& parts) {
    double sum = 0.0;
    for (std::size_t k = 0; k < parts.size(); ++k) sum += area(parts[k]);
    return sum;
}

std::vector<Point> relative(std::vector<Point> corners, Point eye) {
    for (Point& p : corners) p -= eye;
    return corners;
}

// Unit square at z = 1 that looks down.
const std::vector<Point> ceiling{{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}};

// The visible share of `target` from `eye`, exactly.
double visible(const Occluders& occluders, Point eye, const std::vector<Point>& target) {
    VisibleScratch scratch;
    const auto corners = relative(target, eye);
    const auto seen = occluders.look(eye, {corners}, {1000, 4000}, scratch);
    REQUIRE(seen != Visibility::too_many);
    return area(scratch.visible) / area(std::span<const Point>(corners));
}

// A rectangle [0,1]² × {z} as n × n cells, two triangles each, inner vertices shaken.
struct Wall {
    std::vector<Point> points;
    std::vector<std::array<VertexId, 3>> triangles;

    Wall(int n, double z, Rng& rng) {
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= n; ++i) {
                const bool rim = i == 0 || j == 0 || i == n || j == n;
                const double shake = rim ? 0.0 : 0.3 / n;
                points.push_back({static_cast<double>(i) / n + uniform(rng, -shake, shake),
                                  static_cast<double>(j) / n + uniform(rng, -shake, shake), z});
            }
        const auto id = [&](int i, int j) { return VertexId(i + (n + 1) * j); };
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
                triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
            }
    }
    std::vector<ConvexPolygon> unmerged() const {
        std::vector<ConvexPolygon> result;
        for (const auto& t : triangles)
            result.push_back(polygon({points[t[0].value], points[t[1].value], points[t[2].value]}));
        return result;
    }
};

}  // namespace

TEST_CASE("Nothing in the way: the target itself", "[visible_polygon]") {
    const Occluders occluders;
    CHECK(visible(occluders, {0.5, 0.5, 0}, ceiling) == 1.0);
}

TEST_CASE("A wall of many triangles leaks nothing", "[visible_polygon]") {
    Rng rng(1);
    const int cells = GENERATE(1, 3, 8, 15);
    const double z = GENERATE(1e-6, 0.3, 0.7);
    const Wall wall(cells, z, rng);
    const Occluders occluders(wall.unmerged(), 1e-10);
    // The wall covers the target as seen from under its middle, and hardly more.
    for (int k = 0; k < 20; ++k) {
        const Point eye = in_box(rng, {0.4, 0.4, z - 0.9}, {0.6, 0.6, z - 1e-7});
        const double s = (1.0 - eye.z) / (z - eye.z);  // the wall's shadow is larger by this
        std::vector<Point> target;
        for (const Point& p : ceiling)
            target.push_back(
                {eye.x + (p.x - eye.x) * s * 0.999, eye.y + (p.y - eye.y) * s * 0.999, 1.0});
        CHECK(visible(occluders, eye, target) < 1e-12);
    }
}

TEST_CASE("A wall of tilted triangles leaks nothing", "[visible_polygon]") {
    Rng rng(2);
    Wall wall(10, 0.5, rng);
    for (Point& p : wall.points) p.z += 0.05 * std::sin(9.0 * p.x) * std::cos(7.0 * p.y);
    const Occluders occluders(wall.unmerged(), 1e-10);
    const std::vector<Point> target{{0.3, 0.3, 1}, {0.3, 0.7, 1}, {0.7, 0.7, 1}, {0.7, 0.3, 1}};
    for (int k = 0; k < 50; ++k)
        CHECK(visible(occluders, in_box(rng, {0.3, 0.3, 0}, {0.7, 0.7, 0.3}), target) < 1e-12);
}

TEST_CASE("Half covered by an occluder at half the height", "[visible_polygon]") {
    // From below the centre, a screen over x < 0.5 − d hides x < 0.5 − 2 d of the ceiling.
    const double d = GENERATE(0.0, 0.1, 0.2);
    const Occluders occluders(
        std::vector{polygon({{-9, -9, 0.5}, {0.5 - d, -9, 0.5}, {0.5 - d, 9, 0.5}, {-9, 9, 0.5}})},
        1e-10);
    CHECK(visible(occluders, {0.5, 0.5, 0}, ceiling) == Approx(0.5 + 2 * d).epsilon(1e-14));
}

TEST_CASE("Only what lies between hides", "[visible_polygon]") {
    const Point eye{0.5, 0.5, 0};
    const auto square_at = [](double z) {
        return polygon({{-1, -1, z}, {2, -1, z}, {2, 2, z}, {-1, 2, z}});
    };
    for (const double z : {-0.5, 0.0, 1.0, 1.5})
        CHECK(visible(Occluders(std::vector{square_at(z)}, 1e-10), eye, ceiling) == 1.0);
    CHECK(visible(Occluders(std::vector{square_at(0.5)}, 1e-10), eye, ceiling) == 0.0);
    // One that pierces the target hides the part behind it: the fin x = 0.75 from z = 0.9 to 1.1.
    const auto fin = polygon({{0.75, -1, 0.9}, {0.75, 2, 0.9}, {0.75, 2, 1.1}, {0.75, -1, 1.1}});
    const double reach = 0.25 / 0.9;  // where the ray over the fin's foot meets the ceiling
    CHECK(visible(Occluders(std::vector{fin}, 1e-10), eye, ceiling) ==
          Approx(1.0 - (reach - 0.25)).epsilon(1e-13));
}

TEST_CASE("Visible shares against rays, random scenes", "[visible_polygon]") {
    const int scene = GENERATE(range(0, 12));
    Rng rng(100 + scene);
    std::vector<ConvexPolygon> polygons;
    for (int k = 0; k < 3 + 2 * scene; ++k) {
        const Point c = in_box(rng, {0, 0, 0.1}, {1, 1, 0.95});
        const auto near = [&] { return c + in_box(rng, Point(-0.2), Point(0.2)); };
        polygons.push_back(polygon({near(), near(), near()}));
    }
    const Occluders occluders(polygons, 1e-12);
    const Point eye = in_box(rng, {0, 0, 0}, {1, 1, 0.3});
    const double exact = visible(occluders, eye, ceiling);
    const int rays = 100000;
    int open = 0;
    for (int k = 0; k < rays; ++k)
        open += !occluders.blocked(eye, in_box(rng, {0, 0, 1}, {1, 1, 1}) - eye, Reach::finite);
    const double share = static_cast<double>(open) / rays;
    // Four standard errors of a binomial share, and one ray.
    CHECK(std::abs(share - exact) < 4.0 * std::sqrt(exact * (1.0 - exact) / rays) + 1.0 / rays);
}

TEST_CASE("A polygon at infinity is hidden as one far away is", "[visible_polygon]") {
    Rng rng(7);
    std::vector<ConvexPolygon> polygons;
    for (int k = 0; k < 15; ++k) {
        const Point c = in_box(rng, {-1, -1, 0.3}, {1, 1, 2});
        const auto near = [&] { return c + in_box(rng, Point(-0.4), Point(0.4)); };
        polygons.push_back(polygon({near(), near(), near()}));
    }
    const Occluders occluders(polygons, 1e-12);
    const std::vector<Point> disc{{-0.5, -0.5, 1}, {-0.5, 0.5, 1}, {0.5, 0.5, 1}, {0.5, -0.5, 1}};
    std::vector<Point> far;
    for (const Point& p : disc) far.push_back(1e3 * p);
    VisibleScratch a, b;
    const Point eye{0.05, 0.02, 0};
    occluders.look(eye, {disc, Reach::infinite}, {}, a);
    occluders.look(eye, {far, Reach::finite}, {}, b);
    CHECK(area(a.visible) < 0.9);
    CHECK(area(a.visible) == Approx(1e-6 * area(b.visible)).epsilon(1e-12));
}

TEST_CASE("Hierarchy and list see the same", "[visible_polygon]") {
    Rng rng(11);
    Wall wall(40, 0.5, rng);  // 3200 triangles, every seventh left out
    auto all = wall.unmerged();
    std::vector<ConvexPolygon> some;
    for (std::size_t k = 0; k < all.size(); ++k)
        if (k % 7) some.push_back(all[k]);
    const Occluders occluders(some, 1e-12);
    const Point eye{0.5, 0.47, 0.1};
    const std::vector<Point> target{{0.45, 0.45, 1}, {0.45, 0.6, 1}, {0.6, 0.6, 1}, {0.6, 0.45, 1}};
    // A planar grid: the holes' images on the target are the holes' shadows, larger by 0.9/0.4.
    const double exact = visible(occluders, eye, target);
    double holes = 0.0;
    for (std::size_t k = 0; k < all.size(); k += 7) {
        std::vector<Point> image;
        for (const Point& p : all[k].corners) image.push_back(eye + (p - eye) * (0.9 / 0.4));
        std::vector<Point> cut;
        const Direction n[]{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
        const double o[]{0.45, -0.6, 0.45, -0.6};
        for (int side = 0; side < 4; ++side) {
            cut.clear();
            clip(image, n[side], o[side], cut);
            image = cut;
        }
        if (image.size() >= 3) holes += area(std::span<const Point>(image));
    }
    CHECK(exact == Approx(holes / (0.15 * 0.15)).epsilon(1e-10));
}

TEST_CASE("Limits are told, not passed over", "[visible_polygon]") {
    Rng rng(3);
    const Wall wall(6, 0.5, rng);
    const Occluders occluders(wall.unmerged(), 1e-12);
    VisibleScratch scratch;
    const Point eye{0.5, 0.5, 0};
    const auto corners = relative(ceiling, eye);
    CHECK(occluders.look(eye, {corners}, {10, 256}, scratch) == Visibility::too_many);
}

TEST_CASE("The eye on an occluder's plane or rim is not in its shadow", "[visible_polygon]") {
    const auto floor = polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    const auto step = polygon({{0.5, 0, 0}, {0.5, 1, 0}, {0.5, 1, 0.25}, {0.5, 0, 0.25}});
    const Occluders occluders(std::vector{floor, step}, 1e-10);
    CHECK(visible(occluders, {0.25, 0.5, 0}, ceiling) == Approx(1.0).epsilon(1e-14));
    CHECK(visible(occluders, {0.5, 0.5, 0}, ceiling) == 1.0);     // in the step's plane
    CHECK(visible(occluders, {0.5, 0.5, 0.25}, ceiling) == 1.0);  // on its rim
    // A hair before the step's foot half of the ceiling is hidden.
    CHECK(visible(occluders, {0.5 - 1e-7, 0.5, 1e-7}, ceiling) == Approx(0.5).epsilon(1e-5));
}
