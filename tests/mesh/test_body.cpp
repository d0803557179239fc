#include "mesh/body.h"

#include <map>

#include "support/box_mesh.h"
#include "support/catch.h"
#include "support/random_rays.h"

using namespace tyndall;
using namespace tyndall::mesh;

namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

struct Ball {
    std::vector<Point> points;
    Triangles triangles;
};

// An octahedron, every face divided by four `levels` times; corners on the sphere.
Ball ball(Point centre, double radius, int levels) {
    Ball b;
    b.points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    b.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                   {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t i, std::uint32_t j) {
            const auto [entry, made] =
                middles.try_emplace(std::minmax(i, j), static_cast<std::uint32_t>(b.points.size()));
            if (made) b.points.push_back(glm::normalize(b.points[i] + b.points[j]));
            return entry->second;
        };
        Triangles next;
        for (const auto& [i, j, k] : b.triangles) {
            const auto ij = middle(i, j), jk = middle(j, k), ki = middle(k, i);
            next.insert(next.end(), {{i, ij, ki}, {ij, j, jk}, {ki, jk, k}, {ij, jk, ki}});
        }
        b.triangles = std::move(next);
    }
    for (Point& p : b.points) p = centre + radius * p;
    return b;
}

BaseMesh unit_box() {
    return test::box_enclosure({{{0.0, 1.0}, {0.0, 1.0}, {0.0, 1.0}}},
                               [](Point, int) -> std::optional<test::Face> { return {}; })
        .mesh;
}

Point point_in_box(test::Random& random) {
    return {test::uniform(random), test::uniform(random), test::uniform(random)};
}

const Point room_middle(0.4, 0.5, 0.45);
constexpr double radius = 0.3;  // [m]

// The nearest hit by a test of every triangle. Source: Möller & Trumbore (1997).
double nearest(const Ball& b, const Ray& ray) {
    double best = std::numeric_limits<double>::infinity();
    for (const auto& [i, j, k] : b.triangles) {
        const auto e = b.points[j] - b.points[i], f = b.points[k] - b.points[i];
        const auto p = glm::cross(ray.direction, f), s = ray.origin - b.points[i];
        const double det = glm::dot(e, p);
        if (det == 0.0) continue;
        const double u = glm::dot(s, p) / det;
        const auto q = glm::cross(s, e);
        const double v = glm::dot(ray.direction, q) / det, t = glm::dot(f, q) / det;
        if (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0) best = std::min(best, t);
    }
    return best;
}

}  // namespace

TEST_CASE("Rays meet a body of two thousand triangles where a test of each says", "[body]") {
    BaseMesh mesh = unit_box();
    const Ball b = ball(room_middle, radius, 4);
    REQUIRE(b.triangles.size() == 2048);
    add_body(mesh, b.points, b.triangles);
    REQUIRE(mesh.bodies.size() == 1);
    CHECK(mesh.bodies[0].closed);
    test::Random random(7);
    std::size_t hits = 0;
    double worst = 0.0;
    for (int k = 0; k < 20000; ++k) {
        const Ray ray{point_in_box(random), test::random_direction(random)};
        const double expected = nearest(b, ray);
        const BodyHit hit = first_body(mesh, ray);
        REQUIRE(hit.facet.valid() == std::isfinite(expected));
        if (!hit.facet.valid()) continue;
        ++hits;
        worst = std::max(worst, std::abs(hit.distance - expected));
        // From within, backs are seen.
        const bool inside = glm::distance(ray.origin, room_middle) < 0.99 * radius;
        if (inside) CHECK(hit.side == Side::back);
    }
    CHECK(hits > 2000);
    CHECK(worst < 1e-12);
}

TEST_CASE("A ray's length ends before a body that is farther", "[body]") {
    BaseMesh mesh = unit_box();
    const Ball b = ball(room_middle, radius, 2);
    add_body(mesh, b.points, b.triangles);
    Ray ray{{0.01, 0.52, 0.47}, {1, 0, 0}};
    const BodyHit hit = first_body(mesh, ray);
    REQUIRE(hit.facet.valid());
    CHECK(hit.side == Side::front);
    ray.length = 0.999 * hit.distance;
    CHECK_FALSE(first_body(mesh, ray).facet.valid());
    ray.length = 1.001 * hit.distance;
    CHECK(first_body(mesh, ray).facet == hit.facet);
}

TEST_CASE("What lies inside a body, and the nearest place beside it", "[body]") {
    BaseMesh mesh = unit_box();
    const Ball b = ball(room_middle, radius, 3);
    add_body(mesh, b.points, b.triangles);
    test::Random random(3);
    for (int k = 0; k < 2000; ++k) {
        const Point x = point_in_box(random);
        const double distance = glm::distance(x, room_middle);
        if (std::abs(distance - radius) < 0.03 * radius)
            continue;  // facets of up to 13° cut chords
        const Body* around = body_around(mesh, x);
        REQUIRE((around != nullptr) == (distance < radius));
        if (!around) continue;
        const Point out = nearest_outside(mesh, *around, x);
        CHECK(body_around(mesh, out) == nullptr);
        CHECK(glm::distance(out, room_middle) == Approx(radius).epsilon(0.03));
    }
}
