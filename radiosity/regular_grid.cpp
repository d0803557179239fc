#include "radiosity/regular_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "mesh/input_error.h"

namespace tyndall::radiosity {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// The box, and whether anything of the line from begin to end is in it.
bool clip(Point low, Point high, Point origin, Direction direction, double& begin, double& end) {
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0.0) {
            if (origin[axis] < low[axis] || origin[axis] > high[axis]) return false;
            continue;
        }
        double in = (low[axis] - origin[axis]) / direction[axis];
        double out = (high[axis] - origin[axis]) / direction[axis];
        if (in > out) std::swap(in, out);
        begin = std::max(begin, in);
        end = std::min(end, out);
    }
    return begin < end;
}

}  // namespace

RegularGrid::RegularGrid(std::array<std::size_t, 3> counts, Point low, Point high,
                         std::vector<float> values, BeyondGrid beyond)
    : counts_(counts), low_(low), high_(high), beyond_(beyond), values_(std::move(values)) {
    for (int axis = 0; axis < 3; ++axis) {
        if (counts[axis] < 2)
            throw mesh::InputError(fmt::format(
                "a grid of {} × {} × {} points has no cells. Give two points or more along each "
                "axis.",
                counts[0], counts[1], counts[2]));
        if (!(low[axis] < high[axis]) || !std::isfinite(high[axis] - low[axis]))
            throw mesh::InputError(fmt::format(
                "the box of a grid has no inside: min = [{}, {}, {}], max = [{}, {}, {}]. Give a "
                "max above min along each axis.",
                low.x, low.y, low.z, high.x, high.y, high.z));
        per_metre_[axis] = static_cast<double>(counts[axis] - 1) / (high[axis] - low[axis]);
    }
    const double count = double(counts[0]) * double(counts[1]) * double(counts[2]);
    if (static_cast<double>(values_.size()) != count)
        throw mesh::InputError(
            fmt::format("a grid of {} × {} × {} points has {} values. Give one "
                        "a point.",
                        counts[0], counts[1], counts[2], values_.size()));
    const auto bad = std::find_if(values_.begin(), values_.end(),
                                  [](float v) { return !(v >= 0.0f) || !std::isfinite(v); });
    if (bad == values_.end()) return;
    const auto place = static_cast<std::size_t>(bad - values_.begin());
    const std::size_t i = place % counts[0], j = place / counts[0] % counts[1],
                      k = place / counts[0] / counts[1];
    const Point x = low + Direction(i, j, k) / per_metre_;
    throw mesh::InputError(fmt::format(
        "the grid's value {} at its point ({}, {}, {}), which is [{:.6g}, {:.6g}, {:.6g}] m, is "
        "{}. "
        "Give values of 0 or more.",
        *bad, i, j, k, x.x, x.y, x.z, *bad < 0.0f ? "negative" : "not a finite number"));
}

// Of the cell whose lowest point is `first`, u from 0 to 1 along its edges.
double RegularGrid::in_cell(std::size_t first, const Direction& u) const {
    const float* v = values_.data() + first;
    const std::size_t dy = counts_[0], dz = counts_[0] * counts_[1];
    const auto along_x = [&](const float* p) { return p[0] + u.x * (double(p[1]) - p[0]); };
    const double a = along_x(v), b = along_x(v + dy);
    const double c = along_x(v + dz), d = along_x(v + dy + dz);
    const double low = a + u.y * (b - a), high = c + u.y * (d - c);
    return low + u.z * (high - low);
}

double RegularGrid::at(Point x) const {
    if (beyond_ == BeyondGrid::nothing)
        for (int axis = 0; axis < 3; ++axis)
            if (x[axis] < low_[axis] || x[axis] > high_[axis]) return 0.0;
    Direction u = (x - low_) * per_metre_;
    std::size_t first = 0, stride = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double last = static_cast<double>(counts_[axis] - 2);
        const double cell = std::clamp(std::floor(u[axis]), 0.0, last);
        u[axis] = std::clamp(u[axis] - cell, 0.0, 1.0);
        first += stride * static_cast<std::size_t>(cell);
        stride *= counts_[axis];
    }
    return std::max(0.0, in_cell(first, u));
}

double RegularGrid::integral(Point origin, Direction direction, double begin, double end) const {
    if (beyond_ == BeyondGrid::nothing && !clip(low_, high_, origin, direction, begin, end))
        return 0.0;
    if (!(end > begin)) return 0.0;
    // In cells: p + t v; where the next plane is crossed along each axis.
    const Direction v = direction * per_metre_, p = (origin - low_) * per_metre_;
    std::array<double, 3> cell, next, step;
    std::array<std::ptrdiff_t, 3> stride{1, static_cast<std::ptrdiff_t>(counts_[0]),
                                         static_cast<std::ptrdiff_t>(counts_[0] * counts_[1])};
    std::ptrdiff_t first = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double last = static_cast<double>(counts_[axis] - 2);
        cell[axis] = std::clamp(std::floor(p[axis] + begin * v[axis]), 0.0, last);
        first += stride[axis] * static_cast<std::ptrdiff_t>(cell[axis]);
        step[axis] = v[axis] > 0.0 ? 1.0 : -1.0;
        next[axis] = v[axis] == 0.0 ? infinity : (cell[axis] + (v[axis] > 0.0) - p[axis]) / v[axis];
    }
    const auto value = [&](double t) {
        Direction u;
        for (int axis = 0; axis < 3; ++axis)
            u[axis] = std::clamp(p[axis] + t * v[axis] - cell[axis], 0.0, 1.0);
        return in_cell(static_cast<std::size_t>(first), u);
    };
    double sum = 0.0, t = begin, at_t = value(t);
    for (;;) {
        const int axis =
            next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
        const double until = std::min(next[axis], end);
        if (until > t) {
            const double at_end = value(until);
            sum += (until - t) / 6.0 * (at_t + 4.0 * value(0.5 * (t + until)) + at_end);
            t = until;
            at_t = at_end;
        }
        if (next[axis] >= end) return std::max(0.0, sum);
        const double there = cell[axis] + step[axis];
        if (there < 0.0 || there > static_cast<double>(counts_[axis] - 2)) {
            next[axis] = infinity;  // beyond, it stays what it is at the edge
            continue;
        }
        cell[axis] = there;
        first += v[axis] > 0.0 ? stride[axis] : -stride[axis];
        next[axis] = (there + (v[axis] > 0.0) - p[axis]) / v[axis];
    }
}

}  // namespace tyndall::radiosity
