#include "cli/study_curves.h"

#include <algorithm>
#include <cmath>

namespace tyndall::cli {
namespace {

constexpr double flattest = -0.1;  // slopes above it say nothing about what is beyond

double figure_of(const MeasureErrors& errors, Figure figure) {
    if (figure == Figure::rmse) return errors.rmse;
    return figure == Figure::block4 ? errors.block4 : errors.block16;
}

double cost_of(const RunFigures& figures, Cost cost) {
    return cost == Cost::elements ? static_cast<double>(figures.elements()) : figures.cpu_seconds;
}

}  // namespace

std::vector<Curve> curves_of(const std::vector<StudyRow>& rows, const std::string& measure,
                             Figure figure, Cost cost) {
    struct Placed {
        double along;
        CurvePoint point;
    };
    std::vector<std::pair<std::string, std::vector<Placed>>> found;
    for (const auto& row : rows) {
        const auto errors = row.record.errors.find(measure);
        if (row.record.failed() || errors == row.record.errors.end()) continue;
        const CurvePoint point{cost_of(row.record.figures, cost),
                               figure_of(errors->second, figure)};
        if (!(point.error > 0.0) || !(point.cost > 0.0)) continue;
        auto curve = std::find_if(found.begin(), found.end(),
                                  [&](const auto& c) { return c.first == row.run.curve; });
        if (curve == found.end()) {
            found.push_back({row.run.curve, {}});
            curve = std::prev(found.end());
        }
        curve->second.push_back({row.run.along.value_or(0.0), point});
    }
    std::vector<Curve> curves;
    for (auto& [name, placed] : found) {
        std::stable_sort(placed.begin(), placed.end(),
                         [](const Placed& a, const Placed& b) { return a.along > b.along; });
        Curve curve{name, {}};
        for (const auto& p : placed) curve.points.push_back(p.point);
        curves.push_back(std::move(curve));
    }
    return curves;
}

std::optional<double> fitted_slope(const Curve& curve) {
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
    for (const auto& point : curve.points) {
        const double a = std::log(point.cost), b = std::log(point.error);
        n += 1.0;
        x += a;
        y += b;
        xx += a * a;
        xy += a * b;
    }
    const double spread = n * xx - x * x;
    if (n < 2.0 || !(spread > 1e-9 * std::max(1.0, n * xx))) return std::nullopt;
    return (n * xy - x * y) / spread;
}

Need needed_for(const Curve& curve, double error) {
    auto points = curve.points;
    std::stable_sort(points.begin(), points.end(),
                     [](const CurvePoint& a, const CurvePoint& b) { return a.cost < b.cost; });
    std::size_t above = points.size();  // the last point with a larger error
    while (above > 0 && points[above - 1].error <= error) --above;
    if (above == points.size()) {
        const auto slope = fitted_slope(curve);
        const CurvePoint& last = points.back();
        if (!slope || *slope > flattest) return {Need::Kind::more_than, last.cost};
        return {Need::Kind::more_than, last.cost,
                last.cost * std::pow(error / last.error, 1.0 / *slope)};
    }
    if (above == 0) return {Need::Kind::at_most, points.front().cost};
    const auto &a = points[above - 1], &b = points[above];
    const double t = std::log(error / a.error) / std::log(b.error / a.error);
    return {Need::Kind::at, a.cost * std::pow(b.cost / a.cost, t)};
}

}  // namespace tyndall::cli
