// A study's results as tables.
#pragma once

#include <string>
#include <vector>

#include "cli/study_curves.h"
#include "cli/study_file.h"

namespace tyndall::cli {

// Purpose: study.csv: a column an axis, then patches, zones, rays, cpu_seconds, wall_seconds,
//   memory_bytes, for each measure _rmse, _bias, _block4, _block16, the quality of elements, the
//   error that the run itself estimated, and the message of runs that failed. A cell is empty where
//   there is nothing to say.
std::string study_csv(const Study& study, const std::vector<StudyRow>& rows);

// What a curve needs for one of the study's errors.
struct Target {
    std::string curve, measure;
    Figure figure = Figure::rmse;
    double error = 0.0;
    Need elements, cpu_seconds;
};

// Of every measure and figure, in the order of the study's errors and of the curves.
std::vector<Target> targets_of(const Study& study, const std::vector<StudyRow>& rows);

// Purpose: targets.csv: measure, figure, error, curve, elements, cpu_seconds and, as a guess, both
//   by the slope; a cost stands behind "<=" where the curve's first run is good enough, behind ">"
//   where its last is not.
std::string targets_csv(const std::vector<Target>& targets);

// Both tables as one JSON object: rows, targets.
std::string study_json(const Study& study, const std::vector<StudyRow>& rows);

// The figures that a measure has: block errors are of pictures.
std::vector<Figure> figures_of(const StudyMeasure& measure);

}  // namespace tyndall::cli
