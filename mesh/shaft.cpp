#include "mesh/shaft.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace tyndall::mesh {

Shaft::Shaft(std::span<const Point> p, std::span<const Point> q, double tolerance) {
    add(p[0], p[1], p[2], p, q, tolerance);
    add(q[0], q[1], q[2], p, q, tolerance);
    for (const auto& [edges, others] : {std::pair{p, q}, std::pair{q, p}})
        for (std::size_t k = 0; k < edges.size(); ++k)
            for (const Point& other : others)
                add(edges[k], edges[k + 1 == edges.size() ? 0 : k + 1], other, p, q, tolerance);
}

// The plane through three points, if it has everything on one side.
void Shaft::add(Point a, Point b, Point c, std::span<const Point> p, std::span<const Point> q,
                double tolerance) {
    Direction n = glm::cross(b - a, c - a);
    const double length = glm::length(n);
    if (length <= tolerance * glm::distance(a, b)) return;
    n /= length;
    double low = 0.0, high = 0.0;
    for (const auto& corners : {p, q})
        for (const Point& x : corners) {
            low = std::min(low, glm::dot(n, x - a));
            high = std::max(high, glm::dot(n, x - a));
        }
    if (low < -tolerance && high > tolerance) return;
    if (high <= tolerance) n = -n;
    planes_.push_back({n, glm::dot(n, a) + tolerance});
}

bool Shaft::meets(std::span<const Point> polygon) const {
    for (const HalfSpace& plane : planes_)
        if (std::ranges::none_of(
                polygon, [&](const Point& x) { return glm::dot(plane.normal, x) > plane.offset; }))
            return false;
    std::vector<Point> inside(polygon.begin(), polygon.end()), next;
    for (const HalfSpace& plane : planes_) {
        next.clear();
        clip(inside, plane.normal, plane.offset, next);
        if (next.size() < 3) return false;
        inside.swap(next);
    }
    return true;
}

}  // namespace tyndall::mesh
