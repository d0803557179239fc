#include "cli/study_matrix.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "cli/toml_reader.h"
#include "mesh/input_error.h"
#include "render/options.h"

namespace tyndall::cli {
namespace {

std::string last_part(const std::string& key) {
    const auto dot = key.rfind('.');
    return dot == key.npos ? key : key.substr(dot + 1);
}

// For each key its last part, or all of it where two keys share that.
std::map<std::string, std::string> short_names(const std::vector<std::string>& keys) {
    std::map<std::string, int> counts;
    for (const auto& key : keys) ++counts[last_part(key)];
    std::map<std::string, std::string> names;
    for (const auto& key : keys) names[key] = counts[last_part(key)] == 1 ? last_part(key) : key;
    return names;
}

// As a part of a file's name.
std::string for_file(const std::string& text) {
    std::string result;
    for (const char c : text) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                           (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+' || c == '_';
        if (plain)
            result += c;
        else if (!result.empty() && result.back() != '-')
            result += '-';
    }
    constexpr std::size_t longest = 40;
    return result.substr(0, longest);
}

// What tells a matrix's curves from each other and from those of other matrices.
class AxisNames {
  public:
    explicit AxisNames(const Study& study) : short_(short_names(axis_keys(study))) {
        std::map<std::string, std::set<std::string>> values;
        std::map<std::string, std::size_t> matrices;
        for (const auto& matrix : study.matrices)
            for (const auto& axis : matrix.axes) {
                ++matrices[axis.key];
                for (const auto& value : axis.values) values[axis.key].insert(value.toml);
            }
        for (const auto& [key, set] : values)
            if (set.size() == 1 && matrices[key] == study.matrices.size()) same_.insert(key);
    }

    std::string slug_part(const Axis& axis, const AxisValue& value) const {
        return for_file(short_.at(axis.key)) + "-" + for_file(value.label);
    }
    // "" where the value says nothing.
    std::string curve_part(const Matrix& matrix, const Axis& axis, const AxisValue& value) const {
        const bool named = !matrix.name.empty() && axis.values.size() == 1;
        if (named || same_.contains(axis.key)) return "";
        return value.number ? short_.at(axis.key) + " " + value.label : value.label;
    }

  private:
    std::map<std::string, std::string> short_;
    std::set<std::string> same_;  // keys with one value throughout
};

void append(std::string& text, const std::string& part, const char* link) {
    if (!part.empty()) text += (text.empty() ? "" : link) + part;
}

bool changes_scene(const std::string& key) {
    return !key.starts_with("solve.") && !key.starts_with("render.");
}

StudyRun make_run(const Study& study, const Matrix& matrix, const AxisNames& names,
                  const std::vector<std::string>& columns, std::size_t index) {
    StudyRun run;
    run.cells.resize(columns.size());
    run.curve = matrix.name;
    std::vector<const AxisValue*> values(matrix.axes.size());
    for (std::size_t k = matrix.axes.size(); k-- > 0;) {
        const auto& all = matrix.axes[k].values;
        values[k] = &all[index % all.size()];
        index /= all.size();
    }
    for (std::size_t k = 0; k < matrix.axes.size(); ++k) {
        const Axis& axis = matrix.axes[k];
        run.overrides.push_back({axis.key, values[k]->toml, values[k]->place});
        const auto column = std::find(columns.begin(), columns.end(), axis.key) - columns.begin();
        run.cells[static_cast<std::size_t>(column)] = values[k]->label;
        append(run.slug, names.slug_part(axis, *values[k]), "_");
        if (changes_scene(axis.key)) {
            run.scene_overrides.push_back(run.overrides.back());
            append(run.scene_slug, names.slug_part(axis, *values[k]), "_");
        }
        if (matrix.along == k)
            run.along = values[k]->number;
        else
            append(run.curve, names.curve_part(matrix, axis, *values[k]), ", ");
    }
    if (run.curve.empty()) run.curve = study.title;
    return run;
}

void check_flags(const Study& study, const CommonFlags& flags) {
    for (const auto& key : axis_keys(study)) {
        const bool set = std::any_of(flags.settings.begin(), flags.settings.end(),
                                     [&](const Setting& s) { return s.key == key; });
        if (set)
            throw mesh::InputError(
                fmt::format("--set {}: this is an axis of the study. Change it in '{}'.", key,
                            study.file.string()));
        if (flags.seed && key == "solve.seed")
            throw mesh::InputError(
                fmt::format("--seed: the seed is an axis of the study. Change it in '{}'.",
                            study.file.string()));
    }
}

}  // namespace

std::vector<std::string> StudyRun::override_texts() const {
    std::vector<std::string> texts;
    for (const auto& setting : overrides) texts.push_back(setting.text());
    return texts;
}

std::vector<std::string> axis_keys(const Study& study) {
    std::vector<std::string> keys;
    for (const auto& matrix : study.matrices)
        for (const auto& axis : matrix.axes)
            if (std::find(keys.begin(), keys.end(), axis.key) == keys.end())
                keys.push_back(axis.key);
    return keys;
}

std::vector<PlacedSetting> common_settings(const Study& study, const CommonFlags& flags) {
    // Meshes are judged by what their elements hold, on the same rays in every run, unless the
    // study says otherwise.
    std::vector<PlacedSetting> settings{
        {"render.scattering_tolerance", fmt::format("{:g}", render::as_elements_hold), ""},
        {"render.contrast", "0", ""}};
    settings.insert(settings.end(), study.set.begin(), study.set.end());
    for (const auto& setting : flags.settings) settings.push_back({setting.key, setting.value, ""});
    if (flags.seed) settings.push_back({"solve.seed", fmt::format("{}", *flags.seed), ""});
    return settings;
}

std::vector<StudyRun> expand(const Study& study, const CommonFlags& flags) {
    check_flags(study, flags);
    const auto columns = axis_keys(study);
    const auto common = common_settings(study, flags);
    const AxisNames names(study);
    std::vector<StudyRun> runs;
    std::map<std::string, std::size_t> slugs;
    for (const auto& matrix : study.matrices)
        for (std::size_t k = 0; k < matrix.size(); ++k) {
            auto run = make_run(study, matrix, names, columns, k);
            run.overrides.insert(run.overrides.begin(), common.begin(), common.end());
            const auto count = ++slugs[run.slug];
            if (count > 1) run.slug += fmt::format("__{}", count);
            runs.push_back(std::move(run));
        }
    return runs;
}

SceneFile scene_with(const Study& study, const std::vector<PlacedSetting>& overrides) {
    std::vector<std::string> texts;
    for (const auto& setting : overrides) texts.push_back(setting.text());
    try {
        return read_scene_file(study.scene, texts);
    } catch (const mesh::InputError& error) {
        const std::string message = error.what();
        for (const auto& setting : overrides) {
            const std::string prefix = "--set " + setting.text() + ": ";
            if (!setting.place.empty() && message.starts_with(prefix))
                fail_at(setting.place, message.substr(prefix.size()));
        }
        throw;
    }
}

}  // namespace tyndall::cli
