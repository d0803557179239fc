#include "cli/study_reference_keys.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/study_settings.h"
#include "cli/suggestion.h"
#include "cli/toml_text.h"

namespace tyndall::cli {
namespace {

namespace fs = std::filesystem;

bool is_measure(std::string_view key) {
    return std::find(measure_names.begin(), measure_names.end(), key) != measure_names.end();
}

ReferenceSource file_reference(const toml::node& node, const fs::path& folder) {
    const auto place = place_of(node.source());
    const std::string text = *node.value<std::string>();
    const fs::path path = folder / text;
    std::error_code error;
    if (!fs::exists(path, error))
        fail_at(place, fmt::format("the reference \"{}\" is not there (looked for '{}'). Give a "
                                   "path relative to the study file.",
                                   text, path.string()));
    constexpr std::array<std::string_view, 4> endings{".pfm", ".exr", ".csv", ".vtkhdf"};
    const std::string ending = path.extension().string();
    if (!fs::is_directory(path, error) &&
        std::find(endings.begin(), endings.end(), ending) == endings.end())
        fail_at(place, fmt::format("the reference \"{}\" ends on none of {}, and is no folder of a "
                                   "run. Give one that does.",
                                   text, list_of(endings)));
    return {path, {}, place};
}

// A path, or a table of overrides.
ReferenceSource one_reference(const toml::node& node, const fs::path& folder) {
    if (node.is_string()) return file_reference(node, folder);
    const toml::table* table = node.as_table();
    if (!table || table->empty())
        fail_at(place_of(node.source()),
                fmt::format("the reference is {}. Give a path, or a finer run such as "
                            "{{ \"solve.error\" = 0.001 }}.",
                            table ? "an empty table" : type_of(node)));
    for (const auto& entry : dotted_entries(*table))
        if (entry.key.find('.') == entry.key.npos)
            fail_at(entry.place,
                    fmt::format("unknown key \"{}\" in the reference. Overrides have keys with a "
                                "dot, such as \"solve.error\"; measures are {}.",
                                entry.key, list_of(measure_names, "and")));
    return {{}, placed_settings(*table), place_of(node.source())};
}

void check_file_serves(const StudyMeasure& measure) {
    const auto& reference = measure.reference;
    const std::string ending = reference.file.extension().string();
    const auto refuse = [&](std::string_view what, std::string_view instead) {
        fail_at(
            reference.place,
            fmt::format("measure \"{}\" cannot be taken from {} ('{}'). Give {}: reference = "
                        "{{ {} = … }}.",
                        measure.name(), what, reference.file.string(), instead, measure.name()));
    };
    if (measure.of_picture() && ending == ".csv") refuse("probe values", "a picture");
    if (!measure.of_picture() && (ending == ".pfm" || ending == ".exr"))
        refuse("a picture", "probe values or a solution");
}

// A PFM file holds one layer, which cannot be two things.
void check_single_layer(const std::vector<StudyMeasure>& measures) {
    const StudyMeasure* first = nullptr;
    for (const auto& measure : measures) {
        if (!measure.of_picture() || measure.reference.file.extension() != ".pfm") continue;
        if (first && first->reference.file == measure.reference.file)
            fail_at(measure.reference.place,
                    fmt::format("a PFM file holds one layer: '{}' cannot be the reference of both "
                                "{} and {}. Give each its own: reference = {{ {} = …, {} = … }}.",
                                measure.reference.file.string(), first->name(), measure.name(),
                                first->name(), measure.name()));
        first = first ? first : &measure;
    }
}

void read_each(const TableReader& root, const toml::table& table, const fs::path& folder,
               std::vector<StudyMeasure>& measures) {
    for (const auto& [key, node] : table)
        if (!is_measure(key.str()))
            fail_at(
                place_of(key.source()),
                fmt::format("\"{}\" stands in the reference beside a measure's name. Put "
                            "overrides into a table of their own: {{ picture = {{ \"{}\" = … }} "
                            "}}.",
                            key.str(), key.str()));
    for (auto& measure : measures) {
        const toml::node* node = table.get(measure.name());
        if (!node)
            root.fail("reference", fmt::format("measure \"{}\" has no reference. Add {} = ….",
                                               measure.name(), measure.name()));
        measure.reference = one_reference(*node, folder);
    }
}

}  // namespace

void read_references(const TableReader& root, const fs::path& folder,
                     std::vector<StudyMeasure>& measures) {
    const toml::node& node = root.node("reference");
    const toml::table* table = node.as_table();
    const bool each = table && std::any_of(table->begin(), table->end(), [](const auto& entry) {
                          return is_measure(entry.first.str());
                      });
    if (each) {
        read_each(root, *table, folder, measures);
    } else {
        const ReferenceSource source = one_reference(node, folder);
        for (auto& measure : measures) measure.reference = source;
    }
    for (const auto& measure : measures) check_file_serves(measure);
    check_single_layer(measures);
}

}  // namespace tyndall::cli
