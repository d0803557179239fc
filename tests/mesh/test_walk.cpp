#include "mesh/walk.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <optional>

#include "mesh/forest.h"
#include "support/box_mesh.h"
#include "support/catch.h"
#include "support/random_rays.h"
#include "support/ray_scenes.h"

using namespace tyndall;
using namespace tyndall::mesh;

namespace {

// What went wrong, counted; assertions are made once all rays are through.
struct Tally {
    std::size_t rays = 0, lost = 0, gaps = 0, short_of_end = 0, beside_tet = 0, steps = 0;
    double worst_beside = 0.0;  // [m]

    Tally& operator+=(const Tally& other) {
        rays += other.rays, lost += other.lost, gaps += other.gaps;
        short_of_end += other.short_of_end, beside_tet += other.beside_tet, steps += other.steps;
        worst_beside = std::max(worst_beside, other.worst_beside);
        return *this;
    }
};

void walk_one(const BaseMesh& mesh, const test::Shot& shot, bool look_closely, Tally& tally) {
    const double tolerance = 1e-9 * diagonal(mesh);
    double t = 0.0;
    bool contiguous = true;
    const auto end = walk(mesh, shot.ray, shot.start, [&](TetId tet, double t_in, double t_out) {
        contiguous = contiguous && t_in == t && t_out > t_in;
        t = t_out;
        ++tally.steps;
        if (look_closely) {
            const Point middle = shot.ray.origin + 0.5 * (t_in + t_out) * shot.ray.direction;
            const double beside = test::outside_tet(
                [&](int k) { return mesh.points[mesh.tets[tet.value][k].value]; }, middle);
            tally.worst_beside = std::max(tally.worst_beside, beside);
            tally.beside_tet += beside > tolerance;
        }
        return true;
    });
    ++tally.rays;
    tally.lost += end.arrival != Arrival::struck && end.arrival != Arrival::left;
    tally.gaps += !contiguous;
    tally.short_of_end += t != end.distance;
}

// A face that is seen edge-on is crossed somewhere between its corners, rounding says where: such
// rays must arrive, but a piece of theirs may be given to a neighbour.
bool along_a_face(test::RayKind kind) {
    return kind == test::RayKind::in_facet || kind == test::RayKind::axis_at_vertex;
}

Tally walk_many(const BaseMesh& mesh, std::size_t count, std::uint64_t seed) {
    constexpr std::size_t batch = 2000;
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, (count + batch - 1) / batch), Tally{},
        [&](const tbb::blocked_range<std::size_t>& range, Tally tally) {
            for (std::size_t b = range.begin(); b < range.end(); ++b) {
                test::Random random(seed * 1000003 + b);
                for (std::size_t k = 0; k < batch; ++k) {
                    // Half of the rays are random, the others one of the kinds that hurt.
                    const auto kind =
                        k % 2 ? test::RayKind::random : test::RayKind(k / 2 % test::ray_kinds);
                    walk_one(mesh, test::random_shot(mesh, kind, random),
                             k % 16 < 4 && !along_a_face(kind), tally);
                }
            }
            return tally;
        },
        [](Tally a, const Tally& b) { return a += b; });
}

void check(const Tally& tally) {
    CHECK(tally.lost == 0);
    CHECK(tally.gaps == 0);
    CHECK(tally.short_of_end == 0);
    INFO("farthest beside its tet: " << tally.worst_beside << " m");
    CHECK(tally.beside_tet == 0);
}

// Where a ray crosses the polygons, found without the mesh: interfaces up to the first opaque one.
struct Crossings {
    std::vector<double> at;  // distances, ascending; the last one ends the ray
    bool doubtful = false;   // an edge of a polygon is too near to say
};

Crossings brute_force(const std::vector<Polygon>& polygons, const BaseMesh& mesh, const Ray& ray) {
    struct Hit {
        double t;
        Opacity opacity;
    };
    const double near = 1e-5 * diagonal(mesh);
    std::vector<Hit> hits;
    Crossings result;
    for (const Polygon& polygon : polygons) {
        const auto& c = polygon.corners;  // convex in all scenes
        const auto normal = glm::normalize(glm::cross(c[1] - c[0], c[2] - c[0]));
        const double slope = glm::dot(normal, ray.direction);
        const double t = glm::dot(normal, c[0] - ray.origin) / slope;
        if (!(t > -near) || !std::isfinite(t)) continue;
        const Point x = ray.origin + t * ray.direction;
        double inside = 1e300;  // distance from the border
        for (std::size_t k = 0; k < c.size(); ++k) {
            const auto edge = c[(k + 1) % c.size()] - c[k];
            inside =
                std::min(inside, glm::dot(glm::cross(normal, edge), x - c[k]) / glm::length(edge));
        }
        if (std::abs(inside) < near / std::abs(slope) || (std::abs(t) < near && inside > 0.0))
            result.doubtful = true;
        else if (inside > 0.0)
            hits.push_back({t, polygon.opacity});
    }
    // The hull is a box.
    double out = 1e300;
    for (int a = 0; a < 3; ++a)
        if (ray.direction[a] != 0.0)
            out = std::min(
                out, ((ray.direction[a] > 0.0 ? mesh.hull_max : mesh.hull_min)[a] - ray.origin[a]) /
                         ray.direction[a]);
    hits.push_back({out, Opacity::opaque});
    std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.t < b.t; });
    for (const Hit& hit : hits) {
        result.at.push_back(hit.t);
        if (hit.opacity == Opacity::opaque) break;
    }
    return result;
}

// The same from the walk: where it goes from tet to tet through a facet, and its end.
Crossings by_walking(const BaseMesh& mesh, const test::Shot& shot) {
    Crossings result;
    std::optional<TetId> before;
    const auto end = walk(mesh, shot.ray, shot.start, [&](TetId tet, double t_in, double) {
        if (before) {
            const auto& next = mesh.neighbours[before->value];
            const auto k = std::find(next.begin(), next.end(), tet) - next.begin();
            if (k == 4)
                result.doubtful = true;  // a tet between the two was crossed at a point
            else if (mesh.tet_facets[before->value][k].valid())
                result.at.push_back(t_in);
        }
        before = tet;
        return true;
    });
    result.at.push_back(end.distance);
    return result;
}

}  // namespace

TEST_CASE("Ten million rays, none lost", "[walk]") {
    for (const auto& scene : test::ray_scenes()) {
        INFO(scene.name);
        const BaseMesh mesh = test::mesh_of(scene);
        const Tally tally = walk_many(mesh, 2000000, 1);
        CHECK(tally.rays == 2000000);
        check(tally);
    }
}

TEST_CASE("Rays through the vertices and along the edges of a grid", "[walk]") {
    // Integer coordinates: cross products are exact and zero all the time.
    const auto enclosure =
        test::box_enclosure({{{0, 1, 2, 3, 4}, {0, 1, 2, 3, 4}, {0, 1, 2, 3, 4}}},
                            [](Point c, int axis) -> std::optional<test::Face> {
                                if (axis == 2 && c.z == 2.0 && c.x < 2.0)
                                    return test::Face{Opacity::interface};
                                if (c[axis] == 0.0 || c[axis] == 4.0) return test::Face{};
                                return std::nullopt;
                            });
    const BaseMesh& mesh = enclosure.mesh;
    check(walk_many(mesh, 400000, 2));

    // From every tet's vertices, middles of edges and centroid, towards every direction that has
    // components of −2 to 2.
    Tally tally;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        std::vector<Point> origins;
        Point centroid(0.0);
        for (int i = 0; i < 4; ++i) {
            const Point a = mesh.points[mesh.tets[t][i].value];
            centroid += 0.25 * a;
            for (int j = 0; j <= i; ++j)
                origins.push_back(0.5 * (a + mesh.points[mesh.tets[t][j].value]));
        }
        origins.push_back(centroid);
        for (const Point& origin : origins)
            for (int code = 0; code < 125; ++code) {
                const glm::dvec3 d(code % 5 - 2, code / 5 % 5 - 2, code / 25 - 2);
                if (d == glm::dvec3(0.0)) continue;
                test::Shot shot{{origin, glm::normalize(d)}, {TetId(t)}};
                // A start on a tet's rim is one for rays that go into the tet.
                const double into =
                    test::outside_tet([&](int k) { return mesh.points[mesh.tets[t][k].value]; },
                                      origin + 1e-3 * shot.ray.direction);
                if (into <= 1e-12) walk_one(mesh, shot, true, tally);
            }
    }
    check(tally);
}

TEST_CASE("Edge tests fit together, ties included", "[walk]") {
    // Of a face that holds the ray's point no fourth vertex sees all three corners on one side.
    using walk_detail::Projected;
    test::Random random(9);
    const auto is_positive = [](const Projected& a, const Projected& b) {
        return walk_detail::positive(walk_detail::cross(a, b), a, b);
    };
    std::size_t faces = 0, wrong = 0;
    for (int k = 0; k < 400000; ++k) {
        // Small integers tie often; times a third, products round.
        const double unit = k % 2 ? 1.0 : 1.0 / 3.0;
        std::array<Projected, 4> p;
        for (std::uint32_t i = 0; i < 4; ++i)
            p[i] = {unit * (double(random() % 5) - 2), unit * (double(random() % 5) - 2), 0.0, i};
        std::shuffle(p.begin(), p.end(), random);
        const auto& [a, b, c, d] = p;
        wrong += is_positive(a, b) == is_positive(b, a);
        if (!is_positive(a, b) || !is_positive(b, c) || !is_positive(c, a)) continue;
        ++faces;
        wrong += is_positive(a, d) == is_positive(b, d) && is_positive(b, d) == is_positive(c, d);
    }
    CHECK(faces > 10000);
    CHECK(wrong == 0);
}

TEST_CASE("Crossings are those of the polygons", "[walk]") {
    for (const auto& scene : test::ray_scenes()) {
        INFO(scene.name);
        const BaseMesh mesh = test::mesh_of(scene);
        test::Random random(3);
        // Conforming moves points by up to 1e-7 of the diagonal; a ray that meets a polygon at a
        // grazing angle moves farther, hence the polygon's own test of nearness above.
        const double tolerance = 1e-6 * diagonal(mesh);
        std::size_t compared = 0, wrong = 0;
        double worst = 0.0;
        for (int k = 0; k < 10000; ++k) {
            const auto kind = k % 2 ? test::RayKind::random : test::RayKind::from_facet;
            auto shot = test::random_shot(mesh, kind, random);
            if (kind == test::RayKind::from_facet) {
                // Let brute force start off the facet.
                auto& ray = shot.ray;
                ray.origin += 1e-3 * ray.direction;
                shot.start = {locate(mesh, ray.origin, shot.start.tet)};
                if (!shot.start.tet.valid()) continue;
            }
            const Crossings expected = brute_force(scene.polygons, mesh, shot.ray);
            const Crossings found = by_walking(mesh, shot);
            if (expected.doubtful || found.doubtful) continue;
            ++compared;
            bool same = expected.at.size() == found.at.size();
            for (std::size_t n = 0; same && n < found.at.size(); ++n) {
                worst = std::max(worst, std::abs(found.at[n] - expected.at[n]));
                same = std::abs(found.at[n] - expected.at[n]) < tolerance;
            }
            wrong += !same;
        }
        INFO("compared " << compared << ", farthest " << worst << " m");
        CHECK(compared > 9000);
        CHECK(wrong == 0);
    }
}

TEST_CASE("A ray's length ends its walk", "[walk]") {
    const BaseMesh mesh = test::mesh_of({"room", geometry::lit_room()});
    test::Random random(4);
    for (int k = 0; k < 1000; ++k) {
        auto shot = test::random_shot(mesh, test::RayKind::random, random);
        const double whole =
            walk(mesh, shot.ray, shot.start, [](TetId, double, double) { return true; }).distance;
        shot.ray.length = test::uniform(random) * whole;
        double t = 0.0;
        const auto end = walk(mesh, shot.ray, shot.start, [&](TetId, double, double t_out) {
            t = t_out;
            return true;
        });
        REQUIRE(end.arrival == Arrival::ended);
        REQUIRE(end.distance == shot.ray.length);
        REQUIRE(t == shot.ray.length);
    }
}

TEST_CASE("The walk through the leaves fills each tet's segment", "[walk][forest]") {
    for (const auto& scene : test::ray_scenes()) {
        INFO(scene.name);
        const BaseMesh mesh = test::mesh_of(scene);
        Forest forest(mesh);
        test::Random random(5);
        for (int k = 0; k < 5000; ++k) {
            ZoneId zone(test::index_below(random, forest.zone_count()));
            while (!forest.is_leaf(zone))
                zone = ZoneId(forest[zone].first_child.value + random() % 2);
            const auto [i, j] = forest.longest_edge(zone);
            forest.bisect(zone, i, j, random() % 2 ? 0.5 : test::uniform(random, 0.1, 0.9));
        }
        const double tolerance = 1e-9 * diagonal(mesh);
        std::size_t gaps = 0, other_tet = 0, inner = 0;
        double worst = 0.0;
        for (int k = 0; k < 40000; ++k) {
            const auto kind = test::RayKind(k % test::ray_kinds);
            const auto shot = test::random_shot(mesh, kind, random);
            double sum = 0.0;
            std::vector<std::array<double, 2>> tets;  // base tet, exit
            walk(mesh, shot.ray, shot.start, [&](TetId tet, double, double t_out) {
                tets.push_back({double(tet.value), t_out});
                return true;
            });
            double t = 0.0;
            std::size_t n = 0;
            const auto end = walk_zones(
                mesh, forest, shot.ray, shot.start, at_leaves,
                [&](ZoneId zone, double t_in, double t_out) {
                    gaps += t_in != t;
                    t = t_out;
                    sum += t_out - t_in;
                    while (n < tets.size() && tets[n][1] <= t_in) ++n;
                    other_tet += n == tets.size() || forest.base_tet(zone).value != tets[n][0] ||
                                 t_out > tets[n][1];
                    inner += !forest.is_leaf(zone);
                    const double out = test::outside_tet(
                        [&](int c) { return forest.point(forest[zone].corners[c]); },
                        shot.ray.origin + 0.5 * (t_in + t_out) * shot.ray.direction);
                    if (!along_a_face(kind)) worst = std::max(worst, out);
                    return true;
                });
            gaps += t != end.distance;
            // Rounding of a few hundred additions.
            gaps += std::abs(sum - end.distance) > 1e-12 * diagonal(mesh);
        }
        INFO("farthest beside its leaf: " << worst << " m");
        CHECK(gaps == 0);
        CHECK(other_tet == 0);
        CHECK(inner == 0);
        CHECK(worst <= tolerance);
    }
}
