// Inner nodes' fields from their children's, for zones and patches alike.
#pragma once

#include <glm/geometric.hpp>

#include "radiosity/fields.h"

namespace tyndall::radiosity {

// Purpose: the weight of a node in its parent's mean: a zone's volume [m^3] or a patch's area
//   [m^2]. Cost: O(1).
inline double size_of(const Forest& forest, ZoneId zone) {
    return forest.volume(zone);
}
// The same for a patch.
inline double size_of(const Forest& forest, PatchId patch) {
    return forest.area(patch);
}

// Purpose: functions of inner nodes that keep the integral over both children and the means of
//   each: the mean gradient, put right along the line between their centroids.
// `count`: of the forest's nodes of this kind. Cost: O(nodes × bands).
template <class Node>
void coarsen_nodes(const Forest& forest, std::size_t count, Fields& fields) {
    // Children have higher indices than their parents: backwards is bottom-up.
    for (std::size_t n = count; n-- > 0;) {
        const Node parent(n);
        if (forest.is_leaf(parent)) continue;
        const Node first = forest[parent].first_child, second(first.value + 1ull);
        const double s0 = size_of(forest, first), s1 = size_of(forest, second);
        const double w0 = s0 + s1 > 0.0 ? s0 / (s0 + s1) : 0.5, w1 = 1.0 - w0;
        const Point c0 = forest.centroid(first), c1 = forest.centroid(second);
        const auto step = c1 - c0;
        const double square = glm::dot(step, step);
        for (std::size_t b = 0; b < fields.bands; ++b) {
            const Affine &f0 = fields.at(first, b), &f1 = fields.at(second, b);
            const double m0 = f0.at(c0), m1 = f1.at(c1);
            Affine& f = fields.at(parent, b);
            f.gradient = w0 * f0.gradient + w1 * f1.gradient;
            if (square > 0.0)
                f.gradient += step * ((m1 - m0 - glm::dot(f.gradient, step)) / square);
            const double mean = w0 * m0 + w1 * m1;
            f.constant = mean - glm::dot(f.gradient, forest.centroid(parent));
        }
    }
}

}  // namespace tyndall::radiosity
