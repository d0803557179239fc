// Log-log plots as SVG.
#pragma once

#include <string>
#include <vector>

#include "cli/study_curves.h"

namespace tyndall::cli {

struct Plot {
    std::string title, x_label, y_label;  // with units
    std::vector<Curve> curves;
    std::vector<double> levels;  // errors to be marked by a dashed line
};

// Purpose: an SVG picture of the curves on logarithmic axes: lines at decades and, thinner, between
//   them; each curve with a colour and a mark of its own; the legend with the fitted slopes. Errors
//   are drawn in percent. Eight curves can be told apart without colours, too.
// A plot without points says so.
std::string svg_of(const Plot& plot);

// Ticks of a logarithmic axis from low to high: whole decades, and 2 and 5 of each where there are
//   fewer than three of those.
std::vector<double> log_ticks(double low, double high);

// "0.1", "30", "2·10⁵".
std::string tick_text(double value);

}  // namespace tyndall::cli
