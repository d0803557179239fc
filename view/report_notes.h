// What a report says in words beside the solve's own warnings.
#pragma once

#include <string>
#include <vector>

#include "view/mesh_statistics.h"
#include "view/report_facts.h"

namespace tyndall::view {

// Purpose: sentences about what a reader should know of a solution and what could be done: an open
//   hull, zones that are thick for a linear function, a goal that was missed, a stop, a balance
//   that misses much. What a warning of the solve says is not said again. `goal`: solve.error, 0
//   not known [-].
std::vector<std::string> report_notes(const radiosity::Solution& solution, const ReportFacts& facts,
                                      const MeshStatistics& mesh, double goal);

}  // namespace tyndall::view
