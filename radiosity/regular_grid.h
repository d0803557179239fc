// Values on a regular grid, trilinear between its points.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "mesh/types.h"

namespace tyndall::radiosity {

using mesh::Direction;
using mesh::Point;

// What a grid says about places outside its box.
enum class BeyondGrid {
    nothing,  // 0
    edge,     // what stands at the nearest point of the box
};

// Immutable: every call is thread-safe.
class RegularGrid {
  public:
    // `counts`: points along x, y and z, the first and the last on the box's faces; values[i + nx
    // (j + ny k)] is that of point (i, j, k).
    // Errors: mesh::InputError: fewer than two points along an axis, another number of values, a
    // value that is negative or not finite (it says where), a box without an inside.
    RegularGrid(std::array<std::size_t, 3> counts, Point low, Point high, std::vector<float> values,
                BeyondGrid beyond = BeyondGrid::nothing);

    const std::array<std::size_t, 3>& counts() const { return counts_; }
    Point low() const { return low_; }
    Point high() const { return high_; }
    BeyondGrid beyond() const { return beyond_; }
    const std::vector<float>& values() const { return values_; }
    // The edges of a cell [m].
    Direction cell() const { return 1.0 / per_metre_; }

    double at(Point x) const;

    // Purpose: ∫ f ds along origin + s direction, `direction` unit, from s = begin to end [f × m].
    // Method: along a line f is a cubic within each cell, which Simpson's rule integrates exactly.
    // Cost: two interpolations a cell that is crossed, about 20 ns.
    double integral(Point origin, Direction direction, double begin, double end) const;

  private:
    struct Local;
    double in_cell(std::size_t first, const Direction& u) const;

    std::array<std::size_t, 3> counts_;
    Point low_, high_;
    Direction per_metre_;  // cells [1/m]
    BeyondGrid beyond_;
    std::vector<float> values_;
};

}  // namespace tyndall::radiosity
