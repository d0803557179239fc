// A study's results for people: plots and a page of Markdown.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/study_curves.h"
#include "cli/study_file.h"

namespace tyndall::cli {

// Writes plots/MEASURE_FIGURE_COST.svg for every measure and figure, against elements and CPU
//   seconds; where an axis is about the solver, also the solvers' histories (study_histories.h).
void write_plots(const std::filesystem::path& folder, const Study& study,
                 const std::vector<StudyRow>& rows);

// Purpose: study.md: what was run, the elements that each curve needs for the errors asked for and
//   how many times fewer than the first curve that is, the slopes, all runs, the plots, and what
//   failed; where an axis is about the solver, what the solvers did.
// Links are relative to the study's folder.
std::string summary_of(const std::filesystem::path& folder, const Study& study,
                       const std::vector<StudyRow>& rows);

}  // namespace tyndall::cli
