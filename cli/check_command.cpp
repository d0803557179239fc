#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/forecast.h"
#include "cli/scene_statistics.h"
#include "cli/solve_in_words.h"
#include "mesh/input_error.h"

namespace tyndall::cli {
namespace {

using Json = nlohmann::ordered_json;

struct CheckOptions {
    std::string scene;
    bool no_forecast = false;
};

// Everything that the command tells.
struct Checked {
    SceneStatistics statistics;
    std::vector<MediumThickness> media;
    std::vector<std::pair<std::string, std::string>> words;  // label, sentence
    std::optional<Forecast> forecast;
    std::size_t frames = 0;  // of an animation
};

Json as_json(const std::string& scene, const SceneStatistics& s) {
    Json json{{"scene", scene},
              {"polygons", s.polygons},
              {"triangles", s.triangles},
              {"tetrahedra", s.tetrahedra},
              {"hull_min", {s.hull_min.x, s.hull_min.y, s.hull_min.z}},
              {"hull_max", {s.hull_max.x, s.hull_max.y, s.hull_max.z}},
              {"bands", s.bands},
              {"open", s.open},
              {"hull_area", s.hull_area}};
    const auto table = [](const std::vector<Measured>& list, const char* measure) {
        Json array = Json::array();
        for (const auto& entry : list)
            array.push_back({{"name", entry.name}, {measure, entry.size}});
        return array;
    };
    json["sides"] = table(s.sides, "area");
    json["openings"] = table(s.openings, "area");
    json["media"] = table(s.media, "volume");
    json["solids"] = table(s.solids, "volume");
    json["empty_volume"] = s.empty_volume;
    json["lights"] = s.lights;
    json["cameras"] = s.cameras;
    json["memory_foreseen_bytes"] = {{"start", s.memory_start}, {"most", s.memory_most}};
    json["warnings"] = s.warnings;
    return json;
}

Json as_json(const Forecast& f) {
    return {{"start_elements", f.start_elements},
            {"elements", f.elements},
            {"limited", f.limited},
            {"at_least", f.at_least},
            {"solve_cpu_seconds", f.solve_cpu_seconds},
            {"picture_cpu_seconds", f.picture_cpu_seconds},
            {"wall_seconds", f.wall_seconds},
            {"memory_bytes", f.memory},
            {"trial_cpu_seconds", f.trial_cpu_seconds}};
}

Json as_json(const std::string& scene, const Checked& checked) {
    Json json = as_json(scene, checked.statistics);
    for (const auto& medium : checked.media)
        json["optical_thickness"][medium.name] = {{"chord", medium.chord},
                                                  {"thinnest", medium.thinnest},
                                                  {"thickest", medium.thickest},
                                                  {"albedo", medium.albedo}};
    for (const auto& [label, sentence] : checked.words) json["solve"][label] = sentence;
    if (checked.forecast) json["forecast"] = as_json(*checked.forecast);
    return json;
}

std::string sizes(const std::vector<Measured>& list, const char* unit) {
    constexpr std::size_t most = 12;
    std::string text;
    for (std::size_t k = 0; k < std::min(most, list.size()); ++k)
        text += fmt::format("{}{} {:.4g} {}", k == 0 ? "" : ", ", list[k].name, list[k].size, unit);
    if (list.size() > most) text += fmt::format(", and {} more", list.size() - most);
    return list.empty() ? "none" : text;
}

std::string names(const std::vector<std::string>& list) {
    return list.empty() ? "none" : fmt::format("{}", fmt::join(list, ", "));
}

std::string as_text(const std::string& scene, const SceneStatistics& s) {
    auto text = fmt::format("scene    {}: sound\n", scene);
    text += fmt::format("mesh     {} polygons, {} triangles, {} tetrahedra\n", s.polygons,
                        s.triangles, s.tetrahedra);
    text += fmt::format("hull     [{:g}, {:g}, {:g}] to [{:g}, {:g}, {:g}] m\n", s.hull_min.x,
                        s.hull_min.y, s.hull_min.z, s.hull_max.x, s.hull_max.y, s.hull_max.z);
    text += "sides    " + sizes(s.sides, "m2") + "\n";
    text += "media    " + sizes(s.media, "m3") + "\n";
    text += fmt::format("empty    {:.4g} m3\n", s.empty_volume);
    text += "solid    " + sizes(s.solids, "m3") + "\n";
    text += "openings " + sizes(s.openings, "m2") + "\n";
    text += s.open
                ? fmt::format("open     light leaves through {:.4g} m2 of the hull\n", s.hull_area)
                : "open     no: no light leaves the scene\n";
    text += "lights   " + names(s.lights) + "\n";
    text += "cameras  " + names(s.cameras) + "\n";
    text += fmt::format("limits   memory about {:.0f} MB at the start, at most {:.0f} MB\n",
                        s.memory_start / 1e6, s.memory_most / 1e6);
    return text;
}

// Two digits: more is not known.
std::string rounded(double value) {
    if (!(value > 0.0)) return "0";
    const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
    return fmt::format("{:g}", std::round(value / unit) * unit);
}

std::string seconds(double value) {
    return value < 120.0 ? rounded(value) + " s" : rounded(value / 60.0) + " min";
}

std::string as_text(const Forecast& f, std::size_t frames) {
    const char* about = f.at_least ? "more than" : "about";
    auto text =
        fmt::format("elements {} {}, from {}{}\n", about, rounded(double(f.elements)),
                    f.start_elements, f.limited ? "; a limit ends refinement before the goal" : "");
    text += fmt::format("memory   {} {} MB\n", about, rounded(f.memory / 1e6));
    text += fmt::format("time     {} {}{}: {} of CPU to solve", about, seconds(f.wall_seconds),
                        frames > 0 ? " for the first frame" : "", seconds(f.solve_cpu_seconds));
    if (f.picture_cpu_seconds > 0.0)
        text += fmt::format(", {} for the picture", seconds(f.picture_cpu_seconds));
    return text + "\n";
}

std::string as_text(const std::string& scene, const Checked& checked) {
    auto text = as_text(scene, checked.statistics);
    for (const auto& medium : checked.media) text += "medium   " + in_words(medium) + "\n";
    for (const auto& [label, sentence] : checked.words)
        text += fmt::format("{:<9}{}\n", label, sentence);
    if (checked.frames > 0) text += fmt::format("frames   {}\n", checked.frames);
    if (checked.forecast) text += as_text(*checked.forecast, checked.frames);
    for (const auto& warning : checked.statistics.warnings) text += "warning  " + warning + "\n";
    return text;
}

int check(const CheckOptions& options, const CommonFlags& flags) {
    const SceneFile file = load_scene(options.scene, flags);
    ProgressLine progress(flags);
    const auto enclosure = mesh_scene(file, progress);
    Checked checked{statistics_of(file, *enclosure),
                    media_thickness(*enclosure),
                    solve_in_words(file, *enclosure),
                    {},
                    0};
    if (file.animation) checked.frames = file.animation->frames;
    const bool told = flags.json || !flags.quiet;
    if (told && !options.no_forecast) checked.forecast = foresee(file, enclosure, progress);
    progress.clear();
    if (progress.stopped()) throw mesh::InputError("stopped on request: nothing was foreseen.");
    if (flags.json)
        write_output(
            as_json(options.scene, checked).dump(2, ' ', false, Json::error_handler_t::replace) +
            "\n");
    else if (!flags.quiet)
        write_output(as_text(options.scene, checked));
    return 0;
}

}  // namespace

void add_check_command(Shell& shell) {
    const auto options = std::make_shared<CheckOptions>();
    auto command = shell.add_command(
        "check", "Is a scene sound, what will be solved, how long; nothing is written",
        R"(  tyndall check room.toml
  tyndall check room.toml --set solve.error=0.01 --json
  tyndall check room.toml --no-forecast        the mesh and the words alone)",
        [options](const CommonFlags& flags) { return check(*options, flags); });
    add_seed_flag(command, shell.flags());
    add_set_flag(command, shell.flags());
    command.option("SCENE", options->scene, "Scene file").required().file({"toml"});
    command.flag("--no-forecast", options->no_forecast,
                 "No trial of the solve, which foresees elements, time and memory");
}

}  // namespace tyndall::cli
