#include "cli/study_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "cli/scene_optics.h"
#include "cli/study_keys.h"
#include "cli/study_reference_keys.h"
#include "cli/study_settings.h"
#include "cli/suggestion.h"
#include "cli/toml_text.h"
#include "mesh/file_bytes.h"

namespace tyndall::cli {
namespace {

constexpr std::size_t most_runs = 10'000;

toml::table parse(const std::filesystem::path& path) {
    const std::string text = mesh::read_file(path);
    try {
        return toml::parse(text, path.string());
    } catch (const toml::parse_error& error) {
        fail_at(place_of(error.source()),
                fmt::format("this is not valid TOML: {}. Correct it.", error.description()));
    }
}

std::filesystem::path beside(const Study& study, const std::string& path) {
    return study.file.parent_path() / path;
}

std::filesystem::path existing_file(const Study& study, const TableReader& reader,
                                    std::string_view key) {
    const auto path = beside(study, reader.text(key)).lexically_normal();
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
        reader.fail(key, fmt::format("{} \"{}\" is not there (looked for '{}'). Give a path "
                                     "relative to the study file.",
                                     key, reader.text(key), path.string()));
    return path;
}

std::vector<StudyMeasure> read_measures(const TableReader& root) {
    std::vector<StudyMeasure> measures;
    if (!root.has("measure")) return {StudyMeasure{}};
    for (const toml::node& node : root.array("measure")) {
        const auto text = node.value_exact<std::string>().value_or("");
        const auto found = std::find(measure_names.begin(), measure_names.end(), text);
        if (found == measure_names.end()) {
            const auto near = nearest(text, measure_names);
            fail_at(place_of(node.source()),
                    fmt::format(
                        "{} is not one of the measures {}. {}", text_of(node),
                        list_of(measure_names, "or"),
                        near ? fmt::format("Did you mean \"{}\"?", *near) : "Give one of them."));
        }
        const auto kind = static_cast<MeasureKind>(found - measure_names.begin());
        for (const auto& other : measures)
            if (other.kind == kind)
                fail_at(place_of(node.source()),
                        fmt::format("measure \"{}\" stands here twice. Take one away.", text));
        measures.push_back({kind, {}});
    }
    if (measures.empty()) root.fail("measure", "no measure is named. Give one, or leave it out.");
    return measures;
}

AxisValue axis_value(const toml::node& node) {
    AxisValue value{whole_text_of(node), label_of(node), {}, place_of(node.source())};
    if (node.is_number()) value.number = node.value<double>();
    return value;
}

Axis read_axis(const DottedEntry& entry) {
    Axis axis{entry.key, {}, entry.place};
    if (const auto* array = entry.node->as_array()) {
        for (const toml::node& node : *array) axis.values.push_back(axis_value(node));
    } else {
        axis.values.push_back(axis_value(*entry.node));
    }
    if (axis.values.empty())
        fail_at(
            place_of(entry.node->source()),
            fmt::format("axis \"{}\" has no values. Give an array with at least one.", entry.key));
    std::set<std::string> seen;
    for (const auto& value : axis.values)
        if (!seen.insert(value.toml).second)
            fail_at(value.place, fmt::format("axis \"{}\" has the value {} twice. Take one away.",
                                             entry.key, value.toml));
    return axis;
}

// The numeric axis with the most values, the first of several.
std::optional<std::size_t> longest_axis(const std::vector<Axis>& axes) {
    std::optional<std::size_t> longest;
    for (std::size_t k = 0; k < axes.size(); ++k)
        if (axes[k].numeric() && axes[k].values.size() > 1 &&
            (!longest || axes[k].values.size() > axes[*longest].values.size()))
            longest = k;
    return longest;
}

std::string text_option(const DottedEntry& entry, std::string_view what) {
    if (const auto text = entry.node->value_exact<std::string>()) return *text;
    fail_at(place_of(entry.node->source()),
            fmt::format("{} of the axes is {}; a string is expected. Give a string.", what,
                        type_of(*entry.node)));
}

void follow(Matrix& matrix, const DottedEntry& entry) {
    const std::string key = text_option(entry, "along");
    std::vector<std::string> numeric;
    for (std::size_t k = 0; k < matrix.axes.size(); ++k) {
        if (!matrix.axes[k].numeric()) continue;
        numeric.push_back(matrix.axes[k].key);
        if (matrix.axes[k].key == key) matrix.along = k;
    }
    if (!matrix.along || matrix.axes[*matrix.along].key != key)
        fail_at(
            place_of(entry.node->source()),
            fmt::format("along = \"{}\" is no axis with numbers. {}", key, suggest(key, numeric)));
}

Matrix read_matrix(const toml::table& table) {
    Matrix matrix;
    std::optional<DottedEntry> along;
    for (const auto& entry : dotted_entries(table)) {
        if (entry.key == "name") {
            matrix.name = text_option(entry, "name");
        } else if (entry.key == "along") {
            along = entry;
        } else if (entry.key.find('.') == entry.key.npos) {
            fail_at(entry.place,
                    fmt::format("unknown key \"{}\" in the axes. Axes are --set keys such as "
                                "\"solve.error\"; besides them there may be name and along.",
                                entry.key));
        } else {
            matrix.axes.push_back(read_axis(entry));
        }
    }
    std::set<std::string> keys;
    for (const auto& axis : matrix.axes)
        if (!keys.insert(axis.key).second)
            fail_at(axis.place,
                    fmt::format("axis \"{}\" is given twice. Join their values.", axis.key));
    if (matrix.axes.empty())
        fail_at(place_of(table.source()),
                "there is no axis. Give at least one, such as \"solve.error\" = [0.1, 0.03].");
    matrix.along = longest_axis(matrix.axes);
    if (along) follow(matrix, *along);
    return matrix;
}

std::vector<Matrix> read_matrices(const TableReader& root) {
    std::vector<Matrix> matrices;
    const toml::node& node = root.node("axes");
    if (const auto* table = node.as_table()) {
        matrices.push_back(read_matrix(*table));
    } else {
        for (const auto* table : root.tables("axes")) matrices.push_back(read_matrix(*table));
    }
    if (matrices.empty()) root.fail("axes", "there is no axis. Give a table of them.");
    std::size_t runs = 0;
    for (const auto& matrix : matrices) {
        runs += matrix.size();
        if (runs > most_runs)
            root.fail("axes", fmt::format("the study has more than {} runs. Give fewer values.",
                                          most_runs));
    }
    return matrices;
}

std::vector<double> read_errors(const TableReader& root) {
    std::vector<double> errors;
    if (!root.has("errors")) return errors;
    for (const toml::node& node : root.array("errors"))
        errors.push_back(root.number_at(node, "error of the study", {0.0, 1.0, true, true}));
    return errors;
}

void read_places(const TableReader& root, Study& study) {
    if (root.has("probe")) {
        const auto probe = root.table("probe", keys::study_probe(), "[probe]");
        if (probe.has("points")) {
            study.points = existing_file(study, probe, "points");
            study.points_place = probe.where("points");
        }
        if (probe.has("count")) study.probe_count = probe.count("count", 1, 1'000'000);
        if (probe.has("rays")) study.probe_rays = probe.count("rays", 1, std::size_t(1) << 24);
    }
    if (root.has("slice")) {
        const auto slice = root.table("slice", keys::study_slice(), "[slice]");
        study.slice = {slice.vector("point", coordinate), read_direction(slice, "normal")};
    }
}

// What [set] says holds for every run: an axis of the same key would contradict it.
void check_set(const Study& study) {
    for (const auto& setting : study.set)
        for (const auto& matrix : study.matrices)
            for (const auto& axis : matrix.axes)
                if (axis.key == setting.key)
                    fail_at(axis.place,
                            fmt::format("\"{}\" is an axis, and stands in [set] as well ({}). Take "
                                        "one away.",
                                        axis.key, setting.place));
}

}  // namespace

bool Axis::numeric() const {
    return std::all_of(values.begin(), values.end(), [](const auto& v) { return v.number; });
}

std::size_t Matrix::size() const {
    return std::accumulate(axes.begin(), axes.end(), std::size_t(1),
                           [](std::size_t n, const Axis& axis) {
                               return std::min(n * axis.values.size(), 2 * most_runs);
                           });
}

Study read_study_file(const std::filesystem::path& path) {
    const toml::table table = parse(path);
    const TableReader root(table, keys::study(), "the study");
    Study study;
    study.file = path;
    study.scene = existing_file(study, root, "scene");
    study.scene_place = root.where("scene");
    study.title = root.has("title") ? root.text("title") : path.stem().string();
    study.measures = read_measures(root);
    study.matrices = read_matrices(root);
    if (root.has("set")) {
        if (!root.node("set").is_table())
            root.fail("set", "set is not a table. Write [set] and under it solve.rays = 64.");
        study.set = placed_settings(*root.node("set").as_table());
    }
    check_set(study);
    study.errors = read_errors(root);
    read_places(root, study);
    read_references(root, path.parent_path(), study.measures);
    return study;
}

std::string study_file_reference() {
    std::string text;
    for (const KeyTable* table :
         {&keys::study(), &keys::study_axes(), &keys::study_probe(), &keys::study_slice()}) {
        text += fmt::format("### {}\n\n| key | value | default | meaning |\n|---|---|---|---|\n",
                            table->title);
        for (const Key& key : table->keys)
            text += fmt::format("| `{}` | {} | {} | {} |\n", key.name, key.type, key.fallback,
                                key.meaning);
        text += "\n";
    }
    return text;
}

}  // namespace tyndall::cli
