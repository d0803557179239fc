// What the solvers of a study's runs left, step by step, side by side.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/study_curves.h"
#include "cli/study_file.h"
#include "radiosity/solution.h"

namespace tyndall::cli {

// Whether an axis is about the solver (solve.solver, solve.shots, solve.overshooting, …): only then
// are histories of interest.
bool compares_solvers(const Study& study);

// What of a history is drawn, and against what.
struct HistoryPlot {
    std::string file;  // of plots/
    std::string title, x_label, y_label;
    bool against_iterations = false;  // else against CPU time
    double (*value)(const radiosity::SolverStep&) = nullptr;
};
const std::vector<HistoryPlot>& history_plots();

// Purpose: the curve of one history: of the band that took most iterations; steps without time, or
//   with nothing left, have no place on a logarithmic axis. Shots are passes by their share of
//   `elements`.
Curve history_curve(const std::string& name, const std::vector<radiosity::SolverStep>& history,
                    std::size_t elements, const HistoryPlot& plot);

// Writes the plots, from the reports in FOLDER/runs/.
void write_history_plots(const std::filesystem::path& folder, const Study& study,
                         const std::vector<StudyRow>& rows);

// Purpose: the section of study.md: a table of the solvers' last steps, and the plots.
std::string solvers_section(const std::filesystem::path& folder, const std::vector<StudyRow>& rows);

}  // namespace tyndall::cli
