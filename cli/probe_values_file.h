// Probe values from CSV, as `tyndall probe` writes them.
#pragma once

#include <filesystem>
#include <string_view>

#include "cli/solution_points.h"

namespace tyndall::cli {

struct ProbeValuesFile {
    std::vector<SolutionPoint> points;
    PointValues values;  // J of points in space, E of points on sides
};

// Purpose: the points and what was found there, from a table under a line of names: x,y,z and J (or
//   J_0, J_1, … a band), or x,y,z,nx,ny,nz and E (E_0, …), in any order; other columns are passed
//   over.
// Errors: mesh::InputError "file:line: …": a column that lacks, what is no finite number, no row.
ProbeValuesFile parse_probe_values(std::string_view text, const std::filesystem::path& name);

}  // namespace tyndall::cli
