// The mesh of a solution in figures: sizes, shapes, levels, thickness, errors.
#pragma once

#include <string>

#include "view/mesh_statistics.h"

namespace tyndall::view {

// Purpose: a table of the least, the mean and the most of each quantity, and a histogram of each
//   with its numbers folded away.
std::string mesh_figures(const MeshStatistics& mesh);

}  // namespace tyndall::view
