#include "cli/suggestion.h"

#include <fmt/format.h>

#include <algorithm>

namespace tyndall::cli {
namespace {

// Edits (insert, delete, replace, swap of neighbours) that turn a into b: optimal string alignment.
std::size_t edits(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before, above(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) above[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            row[j] = std::min({replaced, above[j] + 1, row[j - 1] + 1});
            const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
        }
        before = above;
        above = row;
    }
    return above[b.size()];
}

}  // namespace

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
    if (known.empty()) return std::nullopt;
    const auto near = std::min_element(known.begin(), known.end(), [&](auto a, auto b) {
        return edits(unknown, a) < edits(unknown, b);
    });
    if (3 * edits(unknown, *near) <= std::max(unknown.size(), near->size())) return *near;
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
