// What was solved, as tables: sizes, surfaces, media, lights, cameras.
#pragma once

#include <string>

#include "view/report_page.h"
#include "view/report_sections.h"

namespace tyndall::view {

// Purpose: the tables of the scene, sizes as `named_sizes` has them.
std::string scene_tables(const radiosity::Solution& solution, const ReportFacts& facts,
                         const ReportPageOptions& options,
                         const std::map<std::string, NamedSize>& sizes);

// Purpose: 4 V / S of every medium, the mean length of chords from wall to wall or into another
//   medium [m]. Source: Cauchy's formula; in radiative transfer the mean beam length of a thin
//   medium.
std::vector<double> mean_chords(const radiosity::Enclosure& enclosure);

}  // namespace tyndall::view
