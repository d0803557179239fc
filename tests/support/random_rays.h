// Rays for the tests of the walk: random ones, and those that hurt.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>

#include "mesh/walk.h"

namespace tyndall::test {

using Random = std::mt19937_64;

inline double uniform(Random& random, double low = 0.0, double high = 1.0) {
    return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
}

inline std::size_t index_below(Random& random, std::size_t count) {
    return static_cast<std::size_t>(random() % count);
}

inline mesh::Direction random_direction(Random& random) {
    const double z = uniform(random, -1.0, 1.0), phi = uniform(random, 0.0, 2 * std::numbers::pi);
    const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
}

// Weights ≥ 0 of sum 1, exponential spacings: uniform in the simplex.
template <std::size_t N>
std::array<double, N> random_weights(Random& random) {
    std::array<double, N> w;
    double sum = 0.0;
    for (double& x : w) sum += x = -std::log1p(-uniform(random));
    for (double& x : w) x /= sum;
    return w;
}

enum class RayKind {
    random,         // from inside a tet, any direction
    at_vertex,      // from inside a tet at a vertex of the mesh
    at_edge,        // from inside a tet at a point of an edge
    in_facet,       // on a facet, along it
    from_facet,     // from a point of a facet
    from_edge,      // from a point of a facet's edge
    from_corner,    // from a facet's corner
    axis_parallel,  // from inside a tet, along an axis
    axis_at_vertex  // along an axis, in line with a vertex of the tet: ties in the edge tests
};
inline constexpr int ray_kinds = 9;

struct Shot {
    mesh::Ray ray;
    mesh::WalkStart start;
};

inline mesh::Point point_in_tet(const mesh::BaseMesh& mesh, mesh::TetId tet, Random& random) {
    const auto w = random_weights<4>(random);
    mesh::Point x(0.0);
    for (int k = 0; k < 4; ++k) x += w[k] * mesh.points[mesh.tets[tet.value][k].value];
    return x;
}

inline mesh::Direction axis(Random& random) {
    mesh::Direction d(0.0);
    d[static_cast<int>(index_below(random, 3))] = random() % 2 ? 1.0 : -1.0;
    return d;
}

inline Shot from_tet(const mesh::BaseMesh& mesh, RayKind kind, Random& random) {
    const mesh::TetId tet(index_below(random, mesh.tets.size()));
    Shot shot{{point_in_tet(mesh, tet, random), random_direction(random)}, {tet}};
    auto& ray = shot.ray;
    if (kind == RayKind::at_vertex) {
        ray.direction = mesh.points[index_below(random, mesh.points.size())] - ray.origin;
    } else if (kind == RayKind::at_edge) {
        const auto& ids = mesh.tets[index_below(random, mesh.tets.size())];
        const double t = random() % 4 ? uniform(random) : 0.5;
        ray.direction =
            (1.0 - t) * mesh.points[ids[0].value] + t * mesh.points[ids[1].value] - ray.origin;
    } else if (kind == RayKind::axis_parallel) {
        ray.direction = axis(random);
    } else if (kind == RayKind::axis_at_vertex) {
        // The middle of an edge or of the tet, and the axis: on grids this meets vertices.
        const auto& ids = mesh.tets[tet.value];
        const auto a = mesh.points[ids[0].value], b = mesh.points[ids[1].value];
        const auto c = mesh.points[ids[2].value], d = mesh.points[ids[3].value];
        ray.origin = random() % 2 ? 0.5 * (a + b) : 0.25 * (a + b + c + d);
        ray.direction = random() % 2 ? axis(random) : b - a;
    }
    ray.direction = glm::normalize(ray.direction);
    return shot;
}

inline Shot from_facet(const mesh::BaseMesh& mesh, RayKind kind, Random& random) {
    const mesh::FacetId facet(index_below(random, mesh.facets.size()));
    const auto& f = mesh.facets[facet.value];
    auto side = random() % 2 ? mesh::Side::front : mesh::Side::back;
    if (!f.tets[side == mesh::Side::front ? 0 : 1].valid()) side = opposite(side);
    const mesh::Point a = mesh.points[f.corners[0].value], b = mesh.points[f.corners[1].value],
                      c = mesh.points[f.corners[2].value];
    auto w = random_weights<3>(random);
    if (kind == RayKind::from_edge) w = {w[0] / (w[0] + w[1]), w[1] / (w[0] + w[1]), 0.0};
    if (kind == RayKind::from_corner) w = {1.0, 0.0, 0.0};
    Shot shot{{w[0] * a + w[1] * b + w[2] * c, random_direction(random)},
              start_on(mesh, facet, side)};
    if (kind == RayKind::in_facet) {
        const double t = random() % 2 ? uniform(random) : 0.0;  // towards an edge or a corner
        shot.ray.direction = glm::normalize((1.0 - t) * b + t * c - shot.ray.origin);
        return shot;
    }
    const auto normal = mesh::normal(mesh, facet) * (side == mesh::Side::front ? 1.0 : -1.0);
    if (glm::dot(normal, shot.ray.direction) < 0.0) shot.ray.direction = -shot.ray.direction;
    return shot;
}

inline Shot random_shot(const mesh::BaseMesh& mesh, RayKind kind, Random& random) {
    switch (kind) {
        case RayKind::in_facet:
        case RayKind::from_facet:
        case RayKind::from_edge:
        case RayKind::from_corner:
            return from_facet(mesh, kind, random);
        default:
            return from_tet(mesh, kind, random);
    }
}

// How far x lies outside a tet, by its four planes, beyond what rounding makes of the planes of
// needles; ≤ 0 inside [m].
template <class Corner>
double outside_tet(Corner&& corner, mesh::Point x) {
    double most = -1e300;
    for (int k = 0; k < 4; ++k) {
        const auto& f = mesh::face_corners[k];
        const mesh::Point a = corner(f[0]), b = corner(f[1]), c = corner(f[2]);
        const auto n = glm::cross(b - a, c - a);
        const double twice_area = glm::length(n);
        if (twice_area == 0.0) continue;
        // Corners round by some 1e-16 of their coordinates; over a needle's width that turns its
        // plane, which x is a length away from.
        const double length = std::max(glm::distance(a, b), glm::distance(a, c));
        const double rounding =
            1e-15 * glm::length(a) * length * (length + glm::distance(x, a)) / twice_area;
        most = std::max(most, glm::dot(n, x - a) / twice_area - rounding);
    }
    return most;
}

}  // namespace tyndall::test
