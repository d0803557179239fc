// Axes of plots: ranges between round numbers, ticks and their texts.
#pragma once

#include <string>
#include <vector>

namespace tyndall::view {

// A range of numbers on an axis of the picture, from `begin` to `end` [pixel]: positive ones by
// their logarithms, or any ones linearly.
struct PlotAxis {
    double low, high, begin, end;
    bool linear = false;

    double at(double value) const;
    bool holds(double value) const;
};

// From one round number to another, with room for the marks; values must be positive, none: 1 to
// 100.
PlotAxis log_axis(std::vector<double> values, double begin, double end);
// From 0 to a little above the largest.
PlotAxis linear_axis(const std::vector<double>& values, double begin, double end);

// Ticks of a logarithmic axis from low to high: whole decades, and 2 and 5 of each where there are
//   fewer than three of those.
std::vector<double> log_ticks(double low, double high);

// Ticks of a linear axis from 0 to high: multiples of 1, 2 or 5 times a power of ten, 4 to 10 of
// them.
std::vector<double> linear_ticks(double high);

std::vector<double> ticks_of(const PlotAxis& axis);

// "0.1", "30", "2·10⁵".
std::string tick_text(double value);

}  // namespace tyndall::view
