// Cubature over the directions to a polygon.
#pragma once

#include <algorithm>
#include <glm/geometric.hpp>

#include "mesh/types.h"
#include "radiosity/cubature.h"

namespace tyndall::radiosity {

using mesh::Direction;
using mesh::Point;

// visit(a, b, c): the parts of a spherical triangle, halved along its longest edges until none
// spans more than 75°.
template <class Visit>
void over_short_triangles(Direction a, Direction b, Direction c, Visit&& visit) {
    constexpr double shortest_cosine = 0.25;
    double ab = glm::dot(a, b), bc = glm::dot(b, c), ca = glm::dot(c, a);
    if (std::min({ab, bc, ca}) < shortest_cosine) {
        while (ab > bc || ab > ca) {  // ab becomes the longest
            std::swap(a, b), std::swap(b, c);
            const double first = ab;
            ab = bc, bc = ca, ca = first;
        }
        const Direction sum = a + b;
        const double length = glm::length(sum);
        if (length > 1e-9) {
            over_short_triangles(a, sum / length, c, visit);
            over_short_triangles(sum / length, b, c, visit);
            return;
        }
    }
    visit(a, b, c);
}

// visit(d, dω): unit directions within the spherical triangle a, b, c, spread over it by the rule.
// It is laid over the plane triangle; that is smooth only while the edges are not too long.
template <class Visit>
void over_directions(Direction a, Direction b, Direction c, std::span<const CubatureNode> rule,
                     Visit&& visit) {
    over_short_triangles(a, b, c, [&](Direction a, Direction b, Direction c) {
        const double volume = std::abs(glm::dot(a, glm::cross(b - a, c - a)));
        for (const auto& q : rule) {
            const Direction towards = q.at[0] * a + q.at[1] * b + q.at[2] * c;
            const double length = glm::length(towards);
            if (length > 0.0)
                visit(towards / length, 0.5 * q.weight * volume / (length * length * length));
        }
    });
}

// The same within a convex polygon seen from the origin.
template <class Visit>
void over_directions(std::span<const Point> polygon, std::span<const CubatureNode> rule,
                     Visit&& visit) {
    const Direction a = glm::normalize(polygon[0]);
    for (std::size_t k = 2; k < polygon.size(); ++k)
        over_directions(a, glm::normalize(polygon[k - 1]), glm::normalize(polygon[k]), rule, visit);
}

}  // namespace tyndall::radiosity
