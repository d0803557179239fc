// "Did you mean …?": the known name nearest to one that is not known.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall::cli {

// The known name nearest to `unknown`: at most a third of its letters off, or one holds the other,
// or they share half their letters from the first on. None if nothing is near.
std::optional<std::string_view> nearest(std::string_view unknown,
                                        std::span<const std::string_view> known);

// A sentence for an error: `Did you mean "reflectance"?` if a known name is near, else
// `Known here: a, b, c.`; empty if nothing is known.
std::string suggest(std::string_view unknown, std::span<const std::string_view> known);
std::string suggest(std::string_view unknown, const std::vector<std::string>& known);

// `a, b and c`, or with another last link; "" for none.
std::string list_of(std::span<const std::string_view> names, std::string_view link = "and");

}  // namespace tyndall::cli
