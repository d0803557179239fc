// Parts of a polygon that are small as a point sees them.
#pragma once

#include <array>
#include <glm/geometric.hpp>
#include <span>
#include <vector>

#include "mesh/types.h"

namespace tyndall::radiosity {

// Purpose: a convex polygon in triangles none of which is wider than `widest` as seen from the
//   origin [rad]: the polygon's fan, halved across the edge that looks longest, in what looks like
//   its middle. Calls on_triangle(std::array<mesh::Point, 3>), of the polygon's orientation.
// Cost: O(solid angle / widest²).
template <class OnTriangle>
void for_narrow_parts(std::span<const mesh::Point> corners, double widest,
                      OnTriangle&& on_triangle) {
    std::vector<std::array<mesh::Point, 3>> open;
    for (std::size_t k = 1; k + 1 < corners.size(); ++k)
        open.push_back({corners[0], corners[k], corners[k + 1]});
    while (!open.empty()) {
        const std::array<mesh::Point, 3> t = open.back();
        open.pop_back();
        double chord = 0.0;
        int edge = 0;
        for (int k = 0; k < 3; ++k) {
            const double length =
                glm::distance(glm::normalize(t[k]), glm::normalize(t[(k + 1) % 3]));
            if (length > chord) chord = length, edge = k;
        }
        if (chord <= widest) {
            on_triangle(t);
            continue;
        }
        const mesh::Point &a = t[edge], &b = t[(edge + 1) % 3], &c = t[(edge + 2) % 3];
        // Seen from the origin, in the middle of the edge.
        const double share = glm::length(a) / (glm::length(a) + glm::length(b));
        const mesh::Point m = a + share * (b - a);
        open.push_back({a, m, c});
        open.push_back({m, b, c});
    }
}

}  // namespace tyndall::radiosity
