// Values on a regular grid, trilinear between its points.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "mesh/types.h"

namespace tyndall::radiosity {

using mesh::Direction;
using mesh::infinity;
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

    // The same values in the same box. Cost: O(points).
    bool operator==(const RegularGrid& other) const {
        return counts_ == other.counts_ && low_ == other.low_ && high_ == other.high_ &&
               beyond_ == other.beyond_ && values_ == other.values_;
    }

    const std::array<std::size_t, 3>& counts() const { return counts_; }
    Point low() const { return low_; }
    Point high() const { return high_; }
    BeyondGrid beyond() const { return beyond_; }
    const std::vector<float>& values() const { return values_; }
    // The edges of a cell [m].
    Direction cell() const { return 1.0 / per_metre_; }
    // Along each axis, how far apart points may be taken that still give all those between them to
    // 1 % of the largest value: what is smaller than that has nothing in it to be missed. At most
    // the box's edge [m].
    Direction grain() const { return grain_; }

    double at(Point x) const;

    // Purpose: ∫ f ds along origin + s direction, `direction` unit, from s = begin to end [f × m].
    // Method: along a line f is a cubic within each cell, which Simpson's rule integrates exactly.
    // Where values differ along one axis only, f is linear between its planes: a trapezium in the
    // first cell and in the last, and sums that are kept for those between.
    // Cost: two interpolations a cell that is crossed, about 20 ns; along one axis the same 10 ns
    // for any number of cells.
    double integral(Point origin, Direction direction, double begin, double end) const;
    // The same of the first and of the second half of the way, in one go.
    std::array<double, 2> halves(Point origin, Direction direction, double begin, double end) const;

  private:
    // Where values differ along one axis only: those, and their integral from the first point on,
    // in cells.
    struct Profile {
        int axis = 0;
        std::vector<double> values, sums{};
        // At, and between, places along the axis in cells.
        double at(double z) const;
        double mean(double from, double to) const;
    };
    template <std::size_t N>
    std::array<double, N> parts(Point origin, Direction direction, double begin,
                                std::array<double, N> ends) const;
    template <std::size_t N>
    std::array<double, N> profile_parts(Point origin, Direction direction, double begin,
                                        const std::array<double, N>& ends) const;
    double in_cell(std::size_t first, const Direction& u) const;
    std::size_t stride(int axis) const {
        return axis == 0 ? 1 : axis == 1 ? counts_[0] : counts_[0] * counts_[1];
    }
    void find_grain();
    void find_profile();

    std::array<std::size_t, 3> counts_;
    Point low_, high_;
    Direction per_metre_;  // cells [1/m]
    BeyondGrid beyond_;
    std::vector<float> values_;
    Direction grain_;
    std::optional<Profile> profile_;
};

}  // namespace tyndall::radiosity
