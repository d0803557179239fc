// Log-log and semi-logarithmic plots as SVG.
#pragma once

#include <string>
#include <vector>

#include "cli/study_curves.h"

namespace tyndall::cli {

struct Plot {
    std::string title, x_label, y_label;  // with units
    std::vector<Curve> curves;
    std::vector<double> levels;  // errors to be marked by a dashed line
    double times = 100.0;        // what errors are multiplied by to be drawn
    bool slopes = true;          // fitted ones, in the legend
    std::size_t marks = 0;       // on a curve, at most; 0: on every point
    bool linear_x = false;       // costs on a linear axis from 0
};

// Purpose: an SVG picture of the curves on logarithmic axes: lines at decades and, thinner, between
//   them; each curve with a colour and a mark of its own; the legend with the fitted slopes. Errors
//   are drawn in percent, if `times` is not another number. Eight curves can be told apart without
//   colours, too.
// A plot without points says so.
std::string svg_of(const Plot& plot);

// Ticks of a logarithmic axis from low to high: whole decades, and 2 and 5 of each where there are
//   fewer than three of those.
std::vector<double> log_ticks(double low, double high);

// Ticks of a linear axis from 0 to high: multiples of 1, 2 or 5 times a power of ten, 4 to 10 of
// them.
std::vector<double> linear_ticks(double high);

// "0.1", "30", "2·10⁵".
std::string tick_text(double value);

}  // namespace tyndall::cli
