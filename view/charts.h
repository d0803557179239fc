// Charts as SVG elements within a page: colours come from the page's style (page/charts.css), so
// that they follow light, dark and paper.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace tyndall::view {

enum class AxisScale { logarithmic, linear };

// What a chart is called, for everybody; `description` is read to those who do not see it.
struct ChartWords {
    std::string title, description;
    std::string x_label, y_label;  // with units
};

struct ChartCurve {
    std::string name;
    std::vector<std::array<double, 2>> points;
};

// A line across that a curve should come down to.
struct ChartLevel {
    std::string name;
    double value = 0.0;  // 0: none
};

// Purpose: curves with marks, y by its logarithm. Points that such an axis cannot show (not above
//   0, no numbers) are left out. "" where not a single curve has two points left.
std::string curve_chart(const ChartWords& words, const std::vector<ChartCurve>& curves,
                        AxisScale x_scale, const ChartLevel& level = {});

struct ChartBar {
    std::string name;
    double value = 0.0;
};

// Purpose: bars to the right of a line (positive) and to its left, in the order given, each with
//   its name and figure. "" without bars.
std::string bar_chart(const ChartWords& words, const std::vector<ChartBar>& bars);

// How many of each kind are between two edges: counts[kind][bin], edges one more than bins.
struct Histogram {
    AxisScale scale = AxisScale::logarithmic;
    std::vector<double> edges;
    std::vector<std::string> kinds;
    std::vector<std::vector<std::size_t>> counts;
    std::vector<std::size_t> zeros;  // of each kind, which a logarithmic axis cannot show
};

// Purpose: kinds[k] values sorted into round bins, at most 24 of them: equal ones by logarithms, or
//   from 0 to 1 in twentieths, or whole numbers. Values that are no numbers do not count.
Histogram log_histogram(std::vector<std::string> kinds,
                        const std::vector<std::vector<double>>& values);
Histogram share_histogram(std::vector<std::string> kinds,
                          const std::vector<std::vector<double>>& values);
Histogram whole_histogram(std::vector<std::string> kinds,
                          const std::vector<std::vector<double>>& values);

// Purpose: bars of the kinds beside each other, in every bin. "" where nothing has been counted.
std::string histogram_chart(const ChartWords& words, const Histogram& histogram);

}  // namespace tyndall::view
