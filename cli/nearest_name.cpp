#include "cli/nearest_name.h"

#include <algorithm>

namespace tyndall::cli {

namespace {

std::size_t edits(const std::string& a, const std::string& b) {
    // Three rows of the distance table: of a's first i − 1, i and i + 1 characters.
    std::vector<std::size_t> before, row(b.size() + 1), next(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 0; i < a.size(); ++i) {
        next[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            next[j + 1] = std::min({row[j + 1] + 1, next[j] + 1, row[j] + (a[i] == b[j] ? 0 : 1)});
            if (i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j])
                next[j + 1] = std::min(next[j + 1], before[j - 1] + 1);
        }
        before = row;
        row.swap(next);
    }
    return row[b.size()];
}

}  // namespace

std::optional<std::string> nearest_name(const std::string& name,
                                        const std::vector<std::string>& known) {
    std::optional<std::string> best;
    std::size_t fewest = 0;
    for (const auto& candidate : known) {
        const std::size_t distance = edits(name, candidate);
        if (3 * distance > std::max(name.size(), candidate.size())) continue;
        if (best && distance >= fewest) continue;
        best = candidate;
        fewest = distance;
    }
    return best;
}

std::string did_you_mean(const std::string& name, const std::vector<std::string>& known) {
    const auto near = nearest_name(name, known);
    return near ? "; did you mean '" + *near + "'?" : "";
}

}  // namespace tyndall::cli
