// How far one solution is from another of the same scene, element by element.
#pragma once

#include <cmath>

#include "radiosity/point_set.h"
#include "radiosity/solution.h"

namespace tyndall::test {

// The root mean square, weighed by area of patches and 4 κ V of zones, of the difference in x at
// four points of every leaf of `reference`, over that of the reference's x. Emission that direct
// light counts in closed form is left out. Both have the same base mesh.
inline double relative_difference(const radiosity::Solution& solution,
                                  const radiosity::Solution& reference) {
    using namespace radiosity;
    const Enclosure& enclosure = *reference.enclosure;
    const Forest& forest = reference.forest;
    const PointSet places(4);
    double squares = 0.0, whole = 0.0;
    const auto add = [&](auto leaf, auto root, const Point& x, double capacity, std::size_t b) {
        const auto other = solution.forest.leaf_at(root, x);
        const auto h = [&](const Solution& s, auto node) {
            return std::max(0.0, s.direct.at(node, b).at(x) + s.indirect.at(node, b).at(x));
        };
        const double a = scatter_of(reference, leaf, b), h_reference = h(reference, leaf);
        const double difference = a * (h(solution, other) - h_reference);
        const bool split = std::is_same_v<decltype(leaf), PatchId>;
        const double value = (split ? 0.0 : emission_of(reference, leaf, b)) + a * h_reference;
        squares += capacity * difference * difference;
        whole += capacity * value * value;
    };
    for (std::size_t z = 0; z < forest.zone_count(); ++z) {
        const ZoneId zone(z);
        const auto medium = medium_of(enclosure, forest, zone);
        if (!forest.is_leaf(zone) || medium == none) continue;
        for (std::size_t k = 0; k < places.size(); ++k) {
            const auto u = places(k, z);
            const auto w = uniform_in_tet(u[0], u[1], u[2]);
            Point x(0.0);
            for (int c = 0; c < 4; ++c) x += w[c] * forest.point(forest[zone].corners[c]);
            for (std::size_t b = 0; b < enclosure.bands; ++b)
                add(zone, mesh::root_zone(forest.base_tet(zone)), x,
                    4.0 * enclosure.media[medium].extinction[b] * forest.volume(zone), b);
        }
    }
    for (std::size_t p = 0; p < forest.patch_count(); ++p) {
        const PatchId patch(p);
        if (!forest.is_leaf(patch) || side_of(enclosure, forest, patch) == none) continue;
        for (std::size_t k = 0; k < places.size(); ++k) {
            const auto u = places(k, p);
            const auto w = uniform_in_triangle(u[0], u[1]);
            Point x(0.0);
            for (int c = 0; c < 3; ++c) x += w[c] * forest.point(forest[patch].corners[c]);
            for (std::size_t b = 0; b < enclosure.bands; ++b)
                add(patch, PatchId(forest.base_facet_side(patch)), x, forest.area(patch), b);
        }
    }
    return whole > 0.0 ? std::sqrt(squares / whole) : 0.0;
}

}  // namespace tyndall::test
