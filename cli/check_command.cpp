#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <map>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/scene_statistics.h"

namespace tyndall::cli {
namespace {

using Json = nlohmann::ordered_json;

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
    text += fmt::format("mesh     {} polygons, {} triangles, {} tetrahedra, {} band{}\n",
                        s.polygons, s.triangles, s.tetrahedra, s.bands, s.bands == 1 ? "" : "s");
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
    text += fmt::format("memory   about {:.0f} MB at the start, at most {:.0f} MB\n",
                        s.memory_start / 1e6, s.memory_most / 1e6);
    for (const auto& warning : s.warnings) text += "warning  " + warning + "\n";
    return text;
}

int check(const std::string& scene, const CommonFlags& flags) {
    const SceneFile file = load_scene(scene, flags);
    ProgressLine progress(flags);
    const auto enclosure = mesh_scene(file, progress);
    const auto statistics = statistics_of(file, *enclosure);
    progress.clear();
    if (flags.json)
        write_output(
            as_json(scene, statistics).dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    else if (!flags.quiet)
        write_output(as_text(scene, statistics));
    return 0;
}

}  // namespace

void add_check_command(Shell& shell) {
    const auto scene = std::make_shared<std::string>();
    auto command =
        shell.add_command("check", "Validate and mesh a scene; nothing is written",
                          R"(  tyndall check room.toml
  tyndall check room.toml --set solve.max_elements=2000000 --json)",
                          [scene](const CommonFlags& flags) { return check(*scene, flags); });
    add_seed_flag(command, shell.flags());
    add_set_flag(command, shell.flags());
    command.option("SCENE", *scene, "Scene file").required();
}

}  // namespace tyndall::cli
