#include "radiosity/regular_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "mesh/input_error.h"

namespace tyndall::radiosity {
namespace {

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
    if (bad == values_.end()) {
        find_grain();
        find_profile();
        return;
    }
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
    if (profile_) return profile_->at(u[profile_->axis]);
    std::size_t first = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double last = static_cast<double>(counts_[axis] - 2);
        const double cell = std::clamp(std::floor(u[axis]), 0.0, last);
        u[axis] = std::clamp(u[axis] - cell, 0.0, 1.0);
        first += stride(axis) * static_cast<std::size_t>(cell);
    }
    return std::max(0.0, in_cell(first, u));
}

// Every second point is left out, and every second of those that are left, as long as the ones left
// out lie on the line between their neighbours.
void RegularGrid::find_grain() {
    constexpr float tolerance = 0.01f;  // of the largest value
    const float most = *std::max_element(values_.begin(), values_.end());
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t last = counts_[axis] - 1, s = stride(axis);
        const auto departs = [&](std::size_t step) {
            for (std::size_t v = 0; v < values_.size(); ++v) {
                const std::size_t at = v / s % counts_[axis], low = at - at % step;
                const std::size_t high = std::min(low + step, last);
                if (low == at || high == at) continue;
                const float t = float(at - low) / float(high - low);
                const float line =
                    (1.0f - t) * values_[v - (at - low) * s] + t * values_[v + (high - at) * s];
                if (std::abs(values_[v] - line) > tolerance * most) return true;
            }
            return false;
        };
        std::size_t step = 1;
        while (step < last && !departs(2 * step)) step *= 2;
        grain_[axis] = static_cast<double>(std::min(step, last)) / per_metre_[axis];
    }
}

void RegularGrid::find_profile() {
    std::optional<int> along;
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t s = stride(axis);
        bool same = true;
        for (std::size_t v = 0; same && v < values_.size(); ++v)
            same = v / s % counts_[axis] == 0 || values_[v] == values_[v - s];
        if (same) continue;
        if (along) return;
        along = axis;
    }
    Profile profile{along.value_or(2), {}};
    for (std::size_t k = 0; k < counts_[profile.axis]; ++k)
        profile.values.push_back(values_[k * stride(profile.axis)]);
    profile.sums.push_back(0.0);
    for (std::size_t k = 1; k < profile.values.size(); ++k)
        profile.sums.push_back(profile.sums.back() +
                               0.5 * (profile.values[k - 1] + profile.values[k]));
    profile_ = std::move(profile);
}

double RegularGrid::Profile::at(double z) const {
    const double last = static_cast<double>(values.size() - 1);
    const double inside = std::clamp(z, 0.0, last), cell = std::min(std::floor(inside), last - 1.0);
    const auto k = static_cast<std::size_t>(cell);
    return values[k] + (inside - cell) * (values[k + 1] - values[k]);
}

// Beyond the ends values stay what they are there.
double RegularGrid::Profile::mean(double from, double to) const {
    const double low = std::min(from, to), high = std::max(from, to);
    if (!(high > low)) return at(low);
    const double last = static_cast<double>(values.size() - 1);
    const double a = std::clamp(low, 0.0, last), b = std::clamp(high, 0.0, last);
    const double at_a = at(a), at_b = at(b);
    const double cell_a = std::floor(a), cell_b = std::min(std::floor(b), last - 1.0);
    double sum = std::max(0.0, std::min(high, 0.0) - low) * at_a +
                 std::max(0.0, high - std::max(low, last)) * at_b;
    if (cell_a >= cell_b) {
        sum += 0.5 * (b - a) * (at_a + at_b);
    } else {
        const auto next = static_cast<std::size_t>(cell_a) + 1;
        const auto end = static_cast<std::size_t>(cell_b);
        sum += 0.5 * (cell_a + 1.0 - a) * (at_a + values[next]) + (sums[end] - sums[next]) +
               0.5 * (b - cell_b) * (values[end] + at_b);
    }
    return sum / (high - low);
}

template <std::size_t N>
std::array<double, N> RegularGrid::profile_parts(Point origin, Direction direction, double begin,
                                                 const std::array<double, N>& ends) const {
    const int axis = profile_->axis;
    const double v = direction[axis] * per_metre_[axis];
    const double p = (origin[axis] - low_[axis]) * per_metre_[axis];
    std::array<double, N> sums;
    for (std::size_t k = 0; k < N; ++k) {
        sums[k] = std::max(0.0, ends[k] - begin) * profile_->mean(p + begin * v, p + ends[k] * v);
        begin = ends[k];
    }
    return sums;
}

template <std::size_t N>
std::array<double, N> RegularGrid::parts(Point origin, Direction direction, double begin,
                                         std::array<double, N> ends) const {
    if (beyond_ == BeyondGrid::nothing) {
        double end = ends.back();
        if (!clip(low_, high_, origin, direction, begin, end)) return {};
        for (double& e : ends) e = std::clamp(e, begin, end);
    }
    if (!(ends.back() > begin)) return {};
    if (profile_) return profile_parts(origin, direction, begin, ends);
    // In cells: p + t v; where the next plane is crossed along each axis.
    const Direction v = direction * per_metre_, p = (origin - low_) * per_metre_;
    // A cell before the first and one after the last stand for what is beyond.
    std::array<double, 3> cell, within, next;
    const std::array<std::size_t, 3> strides{stride(0), stride(1), stride(2)};
    std::size_t first = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double last = static_cast<double>(counts_[axis] - 2);
        cell[axis] = std::clamp(std::floor(p[axis] + begin * v[axis]), -1.0, last + 1.0);
        within[axis] = std::clamp(cell[axis], 0.0, last);
        first += strides[axis] * static_cast<std::size_t>(within[axis]);
        next[axis] = v[axis] == 0.0 ? infinity : (cell[axis] + (v[axis] > 0.0) - p[axis]) / v[axis];
    }
    const auto value = [&](double t) {
        Direction u;
        for (int axis = 0; axis < 3; ++axis)
            u[axis] = std::clamp(p[axis] + t * v[axis] - within[axis], 0.0, 1.0);
        return in_cell(first, u);
    };
    std::array<double, N> sums{};
    std::size_t part = 0;
    double t = begin, at_t = value(t);
    for (;;) {
        const int axis =
            next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
        const double until = std::min(next[axis], ends[part]);
        if (until > t) {
            const double at_end = value(until);
            sums[part] += (until - t) / 6.0 * (at_t + 4.0 * value(0.5 * (t + until)) + at_end);
            t = until;
            at_t = at_end;
        }
        if (next[axis] >= ends[part]) {
            if (++part == N) break;
            continue;
        }
        const double there = cell[axis] + (v[axis] > 0.0 ? 1.0 : -1.0);
        const double last = static_cast<double>(counts_[axis] - 2);
        if (there < -1.0 || there > last + 1.0) {
            next[axis] = infinity;
            continue;
        }
        cell[axis] = there;
        if (const double now = std::clamp(there, 0.0, last); now != within[axis]) {
            first = v[axis] > 0.0 ? first + strides[axis] : first - strides[axis];
            within[axis] = now;
        }
        next[axis] = (there + (v[axis] > 0.0) - p[axis]) / v[axis];
    }
    for (double& sum : sums) sum = std::max(0.0, sum);
    return sums;
}

double RegularGrid::integral(Point origin, Direction direction, double begin, double end) const {
    return parts<1>(origin, direction, begin, {end})[0];
}

std::array<double, 2> RegularGrid::halves(Point origin, Direction direction, double begin,
                                          double end) const {
    return parts<2>(origin, direction, begin, {0.5 * (begin + end), end});
}

}  // namespace tyndall::radiosity
