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

}  // namespace tyndall::cli
