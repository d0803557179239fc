// Files that follow each other in time, as ParaView plays them.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace tyndall::cli {

// Purpose: the text of a .vtkhdf.series file: names, relative to its folder, and times.
// Source: ParaView, "File series" (JSON, version 1.0).
std::string file_series(const std::vector<std::pair<std::string, double>>& files);

}  // namespace tyndall::cli
