#include "radiosity/open_places.h"

#include <algorithm>
#include <optional>

#include "radiosity/point_set.h"

namespace tyndall::radiosity {
namespace {

// Points on a surface are taken this far before it, of the hull's diagonal: a body may stand on it.
constexpr double before_surface = 1e-7;

template <class Node>
bool near_body(const Enclosure& enclosure, const Forest& forest, Node node) {
    const Point centroid = forest.centroid(node);
    double reach = 0.0;
    for (const VertexId corner : forest[node].corners)
        reach = std::max(reach, glm::distance(forest.point(corner), centroid));
    return std::ranges::any_of(enclosure.mesh.bodies, [&](const mesh::Body& body) {
        return body.closed && glm::distance(body.centre, centroid) <= body.radius + reach;
    });
}

// 0 where a body covers all corners, else 1.
template <class Node>
double by_corners(const Enclosure& enclosure, const Forest& forest, Node node, Direction normal) {
    const auto& corners = forest[node].corners;
    return std::ranges::all_of(
               corners, [&](VertexId c) { return covered(enclosure, forest.point(c), normal); })
               ? 0.0
               : 1.0;
}

template <class Place>
double share(std::size_t count, std::uint64_t seed, const Place& open) {
    // Asked for at every leaf beside a body: these are not made anew each time.
    static const PointSet of_element(element_share_points), of_leaf(leaf_share_points);
    std::optional<PointSet> other;
    if (count != element_share_points && count != leaf_share_points) other.emplace(count);
    const PointSet& points = other ? *other : count == element_share_points ? of_element : of_leaf;
    std::size_t inside = 0;
    for (std::size_t k = 0; k < points.size(); ++k) inside += !open(points(k, seed));
    return 1.0 - static_cast<double>(inside) / static_cast<double>(points.size());
}

}  // namespace

bool covered(const Enclosure& enclosure, Point x, Direction normal) {
    const auto& mesh = enclosure.mesh;
    if (mesh.bodies.empty()) return false;
    const double before = before_surface * glm::distance(mesh.hull_min, mesh.hull_max);
    return mesh::body_around(mesh, x + before * normal) != nullptr;
}

OpenPlace open_place(const Enclosure& enclosure, Point x, TetId tet) {
    const auto& mesh = enclosure.mesh;
    if (mesh.bodies.empty()) return {x, tet};
    const mesh::Body* body = mesh::body_around(mesh, x);
    if (!body) return {x, tet};
    const Point moved = mesh::nearest_outside(mesh, *body, x);
    const TetId there = mesh::locate(mesh, moved, tet);
    // In another medium, in a wall or another body there is nothing to go on from.
    if (!there.valid() || enclosure.solid(there) ||
        enclosure.medium_of(there) != enclosure.medium_of(tet) || covered(enclosure, moved))
        return {x, tet};
    return {moved, there};
}

double open_share(const Enclosure& enclosure, const Forest& forest, ZoneId zone,
                  std::size_t points) {
    if (enclosure.mesh.bodies.empty() || !near_body(enclosure, forest, zone)) return 1.0;
    const auto& c = forest[zone].corners;
    if (points == 0) return by_corners(enclosure, forest, zone, Direction(0.0));
    return share(points, zone.value, [&](const auto& u) {
        const auto w = uniform_in_tet(u[0], u[1], u[2]);
        Point x(0.0);
        for (int k = 0; k < 4; ++k) x += w[k] * forest.point(c[k]);
        return !covered(enclosure, x);
    });
}

double open_share(const Enclosure& enclosure, const Forest& forest, PatchId patch,
                  std::size_t points) {
    if (enclosure.mesh.bodies.empty() || !near_body(enclosure, forest, patch)) return 1.0;
    const auto& c = forest[patch].corners;
    const Direction normal = normal_of(forest, patch);
    if (points == 0) return by_corners(enclosure, forest, patch, normal);
    return share(points, patch.value, [&](const auto& u) {
        const auto w = uniform_in_triangle(u[0], u[1]);
        const Point x =
            w[0] * forest.point(c[0]) + w[1] * forest.point(c[1]) + w[2] * forest.point(c[2]);
        return !covered(enclosure, x, normal);
    });
}

}  // namespace tyndall::radiosity
