// Points numbered so that two within a distance of each other are one.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "mesh/types.h"

namespace tyndall::mesh {

// The first point to come stands for all later ones within `distance` of it: the result depends on
// the order of the points only. Cost: O(1) a point.
class PointWeld {
  public:
    // distance > 0 [m]
    explicit PointWeld(double distance) : distance_(distance) {}

    // The number of the point nearest to x within the distance; x becomes a new point if there is
    // none.
    std::uint32_t number(Point x);

    const std::vector<Point>& points() const { return points_; }

  private:
    struct Cell {
        std::int64_t x, y, z;
        bool operator==(const Cell&) const = default;
    };
    struct CellHash {
        std::size_t operator()(const Cell& cell) const noexcept;
    };

    Cell cell_of(Point x) const;

    double distance_;
    std::vector<Point> points_;
    std::unordered_map<Cell, std::vector<std::uint32_t>, CellHash> cells_;
};

}  // namespace tyndall::mesh
