#include "cli/suggestion.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/nearest_name.h"

namespace tyndall::cli {

std::string list_of(std::span<const std::string_view> names, std::string_view link) {
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i > 0) text += i + 1 == names.size() ? fmt::format(" {} ", link) : ", ";
        text += names[i];
    }
    return text;
}

std::optional<std::string_view> nearest(std::string_view unknown,
                                        std::span<const std::string_view> known) {
    const std::vector<std::string> names(known.begin(), known.end());
    if (const auto near = nearest_name(std::string(unknown), names)) {
        return *std::find(known.begin(), known.end(), *near);
    }
    for (const std::string_view name : known) {  // fov → fov_x, rotation → rotate
        const bool inside = unknown.find(name) != unknown.npos || name.find(unknown) != name.npos;
        if (inside && unknown.size() > 2 && name.size() > 2) return name;
        const auto end = std::mismatch(unknown.begin(), unknown.end(), name.begin(), name.end());
        const auto shared = static_cast<std::size_t>(end.first - unknown.begin());
        if (shared >= 3 && 2 * shared >= std::max(unknown.size(), name.size())) return name;
    }
    return std::nullopt;
}

std::string suggest(std::string_view unknown, std::span<const std::string_view> known) {
    if (known.empty()) return "";
    if (const auto near = nearest(unknown, known))
        return fmt::format("Did you mean \"{}\"?", *near);
    return fmt::format("Known here: {}.", list_of(known));
}

std::string suggest(std::string_view unknown, const std::vector<std::string>& known) {
    const std::vector<std::string_view> views(known.begin(), known.end());
    return suggest(unknown, std::span<const std::string_view>(views));
}

}  // namespace tyndall::cli
