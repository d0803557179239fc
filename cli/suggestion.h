// "Did you mean …?": the known name nearest to one that is not known.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall::cli {

// Edits (insert, delete, replace, swap of neighbours) that turn a into b. Cost: O(|a| |b|).
std::size_t edit_distance(std::string_view a, std::string_view b);

// A sentence for an error: `Did you mean "reflectance"?` if a known name is near (a third of its
// letters, or one contains the other), else `Known here: a, b, c.`; empty if nothing is known.
std::string suggest(std::string_view unknown, std::span<const std::string_view> known);
std::string suggest(std::string_view unknown, const std::vector<std::string>& known);

// `a, b and c`, or with another last link; "" for none.
std::string list_of(std::span<const std::string_view> names, std::string_view link = "and");

}  // namespace tyndall::cli
