#include "cli/report_file.h"

#include <fmt/format.h>

#include <toml++/toml.h>

#include "mesh/file_bytes.h"
#include "view/report_page.h"

namespace tyndall::cli {
namespace {

std::string picture_words(const ViewSettings& settings, const std::string& title) {
    std::string camera = settings.view_camera;
    if (camera.empty() && !settings.cameras.empty()) camera = settings.cameras.front().name;
    return camera.empty() ? title : fmt::format("{}, seen by camera {}", title, camera);
}

void for_each_table(const toml::table& root, const char* key, auto&& visit) {
    const auto* array = root[key].as_array();
    if (array == nullptr) return;
    for (const auto& node : *array)
        if (const auto* table = node.as_table()) visit(*table);
}

}  // namespace

ReportedScene reported_scene(const std::string& toml) {
    ReportedScene scene;
    toml::table root;
    try {
        root = toml::parse(toml);
    } catch (const toml::parse_error&) {
        return scene;
    }
    std::map<std::string, std::string> back_of;  // of a material
    for_each_table(root, "material", [&](const toml::table& table) {
        if (const auto back = table["back"].value<std::string>())
            back_of[table["name"].value_or(std::string())] = *back;
    });
    for_each_table(root, "surface", [&](const toml::table& table) {
        const auto name = table["name"].value_or(std::string());
        const auto material = table["material"].value<std::string>();
        if (!material) return;
        scene.materials[name] = *material;
        if (const auto back = back_of.find(*material); back != back_of.end())
            scene.backs[name] = back->second;
    });
    scene.goal = root["solve"]["error"].value_or(scene.goal);
    return scene;
}

std::string material_of(const ReportedScene& scene, const std::string& side) {
    if (side.empty()) return "";
    const bool back = side.back() == '-';
    std::string name = side.substr(0, side.size() - 1);
    for (;;) {
        if (const auto found = scene.backs.find(name); back && found != scene.backs.end())
            return found->second;
        if (const auto found = scene.materials.find(name); found != scene.materials.end())
            return found->second;
        const auto dot = name.rfind('.');
        if (dot == std::string::npos) return "";
        name.resize(dot);
    }
}

void write_report(const std::filesystem::path& path, const radiosity::Solution& solution,
                  const ViewSettings& settings, const ReportParts& parts) {
    const ReportedScene scene = reported_scene(parts.scene_text);
    view::ReportPageOptions options;
    options.title = settings.title.empty() ? parts.untitled : settings.title;
    options.report = parts.report;
    for (const auto& side : solution.enclosure->sides)
        if (const auto material = material_of(scene, side.name); !material.empty())
            options.materials[side.name] = material;
    options.cameras = settings.cameras;
    options.view_camera = settings.view_camera;
    options.goal = parts.scene_text.empty() ? 0.0 : scene.goal;
    if (!parts.picture.empty()) {
        options.picture = mesh::read_file(parts.picture);
        options.picture_alternative = picture_words(settings, options.title);
    }
    options.scene_text = parts.scene_text;
    options.view_link = parts.view_link;
    options.notes = parts.notes;
    mesh::write_file(path, view::report_page(solution, options));
}

}  // namespace tyndall::cli
