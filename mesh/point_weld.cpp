#include "mesh/point_weld.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace tyndall::mesh {

std::size_t PointWeld::CellHash::operator()(const Cell& cell) const noexcept {
    std::uint64_t hash = 0x9E3779B97F4A7C15ull;
    for (const auto k : {cell.x, cell.y, cell.z}) {
        hash = (hash ^ static_cast<std::uint64_t>(k)) * 0xBF58476D1CE4E5B9ull;
        hash ^= hash >> 29;
    }
    return hash;
}

// Cells four distances wide: most searches look into one cell, none into more than eight.
PointWeld::Cell PointWeld::cell_of(Point x) const {
    const auto index = [&](double t) {
        return static_cast<std::int64_t>(std::floor(t / (4.0 * distance_)));
    };
    return {index(x.x), index(x.y), index(x.z)};
}

std::uint32_t PointWeld::number(Point x) {
    const auto low = cell_of(x - Point(distance_)), high = cell_of(x + Point(distance_));
    auto nearest = static_cast<std::uint32_t>(points_.size());
    double least = distance_;
    for (auto i = low.x; i <= high.x; ++i) {
        for (auto j = low.y; j <= high.y; ++j) {
            for (auto k = low.z; k <= high.z; ++k) {
                const auto found = cells_.find({i, j, k});
                if (found == cells_.end()) {
                    continue;
                }
                for (const auto candidate : found->second) {
                    const double away = glm::distance(points_[candidate], x);
                    if (away < least || (away == least && candidate < nearest)) {
                        least = away;
                        nearest = candidate;
                    }
                }
            }
        }
    }
    if (nearest == points_.size()) {
        cells_[cell_of(x)].push_back(nearest);
        points_.push_back(x);
    }
    return nearest;
}

}  // namespace tyndall::mesh
