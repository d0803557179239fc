#include "cli/study_settings.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/toml_text.h"

namespace tyndall::cli {
namespace {

// As --set takes it: in quotes where it holds a dot or an '='.
std::string part(std::string_view key) {
    const bool plain = key.find_first_of(".=\"' ") == key.npos;
    return plain ? std::string(key) : fmt::format("\"{}\"", key);
}

void open_table(const toml::table& table, const std::string& prefix, bool quoted_path,
                std::vector<std::pair<toml::source_position, DottedEntry>>& entries) {
    for (const auto& [key, node] : table) {
        // A key at the top that holds dots is a path already.
        const std::string path =
            prefix.empty() && quoted_path ? std::string(key.str()) : prefix + part(key.str());
        if (const auto* inner = node.as_table()) {
            open_table(*inner, path + ".", quoted_path, entries);
            continue;
        }
        entries.push_back({key.source().begin, {path, &node, place_of(key.source())}});
    }
}

}  // namespace

std::vector<DottedEntry> dotted_entries(const toml::table& table) {
    std::vector<std::pair<toml::source_position, DottedEntry>> found;
    open_table(table, "", true, found);
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<DottedEntry> entries;
    for (auto& [position, entry] : found) entries.push_back(std::move(entry));
    return entries;
}

std::vector<PlacedSetting> placed_settings(const toml::table& table) {
    std::vector<PlacedSetting> settings;
    for (const auto& entry : dotted_entries(table))
        settings.push_back({entry.key, whole_text_of(*entry.node), place_of(entry.node->source())});
    return settings;
}

std::string label_of(const toml::node& node) {
    if (const auto* text = node.as_string()) return text->get();
    return whole_text_of(node);
}

}  // namespace tyndall::cli
