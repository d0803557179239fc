// "Did you mean …?"
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace tyndall::cli {

// Purpose: the known name that a mistyped one most likely meant; none if all are too far off.
// Method: least count of inserted, deleted, changed and swapped neighbouring characters (optimal
//   string alignment); at most a third of the longer name's length may differ. First one wins a
//   tie.
std::optional<std::string> nearest_name(const std::string& name,
                                        const std::vector<std::string>& known);

// "; did you mean 'solve'?", or "" if nothing is near.
std::string did_you_mean(const std::string& name, const std::vector<std::string>& known);

}  // namespace tyndall::cli
