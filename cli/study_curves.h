// A study's results as curves: error against what it took.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "cli/study_matrix.h"
#include "cli/study_record.h"

namespace tyndall::cli {

// A run and what came of it.
struct StudyRow {
    StudyRun run;
    RunRecord record;
};

enum class Figure { rmse, block4, block16 };
inline constexpr std::array<std::string_view, 3> figure_names{"rmse", "block4", "block16"};
enum class Cost { elements, cpu_seconds };
inline constexpr std::array<std::string_view, 2> cost_names{"elements", "cpu_seconds"};

struct CurvePoint {
    double cost = 0.0, error = 0.0;
};

struct Curve {
    std::string name;
    std::vector<CurvePoint> points;  // by the value on the axis that the curve follows
};

// Purpose: the curves of one figure of a measure; rows that failed, and errors that are no positive
//   number, are left out, curves without a point too.
std::vector<Curve> curves_of(const std::vector<StudyRow>& rows, const std::string& measure,
                             Figure figure, Cost cost);

// Purpose: the exponent p of error ~ cost^p, by least squares of the logarithms. None with fewer
//   than two different costs.
std::optional<double> fitted_slope(const Curve& curve);

// What a curve needs for an error: at a cost found by interpolation; at most its smallest cost; or
//   more than its largest, and then perhaps `by_slope`: what it would need if it went on from its
//   last run with its fitted slope. That is a guess, and is shown as one.
struct Need {
    enum class Kind { at, at_most, more_than };
    Kind kind = Kind::more_than;
    double cost = 0.0;
    std::optional<double> by_slope{};

    // The best guess there is.
    double guess() const { return by_slope.value_or(cost); }
};

// Purpose: the cost from which on the curve stays at or below `error`, by interpolation of the
//   logarithms between the points by cost. Requires a point.
Need needed_for(const Curve& curve, double error);

}  // namespace tyndall::cli
