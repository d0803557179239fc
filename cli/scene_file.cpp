#include "cli/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "cli/overrides.h"
#include "cli/scene_cameras.h"
#include "cli/scene_keys.h"
#include "cli/scene_optics.h"
#include "cli/scene_spectrum.h"
#include "cli/scene_surfaces.h"
#include "cli/settings.h"
#include "cli/toml_text.h"
#include "mesh/input_error.h"
#include "radiosity/exchange_methods.h"

namespace tyndall::cli {
namespace {

void check_format(const TableReader& root) {
    if (!root.has("format")) {
        fail_at(root.where(), "the scene has no format. Begin the file with format = 1.");
    }
    const double format = root.number("format", {-1e9, 1e9});
    if (format != 1.0) {
        root.fail("format", fmt::format("format {} of the scene is not known. This program reads "
                                        "format = 1.",
                                        format));
    }
}

void read_cameras(const TableReader& root, Names& names, SceneFile& file) {
    for (const toml::table* table : root.tables("camera")) {
        const std::string name = names.take(*table);
        const TableReader reader(*table, keys::camera(), fmt::format("camera \"{}\"", name));
        file.cameras.push_back(read_camera(reader, name));
        file.scene.viewpoints.push_back(file.cameras.back().eye);
    }
}

// solve.camera: a camera's name, "" for none; the first camera where it is not given.
std::string view_camera(const TableReader& root, const std::optional<std::string>& given,
                        const Names& names) {
    if (!given) return names.all().empty() ? "" : names.all().front();
    if (!given->empty()) names.find(root.table("solve", solve_keys(), "[solve]"), "camera");
    return *given;
}

// solve.mesh beside the scene file, where solve.start asks for it.
std::filesystem::path own_tetrahedra(const TableReader& root, const Settings& settings,
                                     const std::filesystem::path& folder,
                                     std::vector<std::string>& notes) {
    if (settings.solve.start != radiosity::Start::mesh) {
        if (!settings.mesh.empty())
            notes.push_back("solve.mesh is not used, as solve.start is not \"mesh\"");
        return {};
    }
    const TableReader solve = root.table("solve", solve_keys(), "[solve]");
    if (settings.mesh.empty())
        solve.fail(solve.has("mesh") ? "mesh" : "start",
                   "start of [solve] is \"mesh\", but no file is given. Give mesh = \"file.msh\", "
                   "or take start = \"base\".");
    const auto path = folder / settings.mesh;
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored))
        solve.fail("mesh", fmt::format("mesh of [solve]: there is no file '{}'. Correct the path; "
                                       "it is taken from the scene file's folder.",
                                       path.string()));
    return path;
}

// solve.mirrors, or what the exchange method can do where that is not given.
radiosity::Mirrors mirrors_of(const TableReader& root, const Settings& settings,
                              const radiosity::Scene& scene, std::vector<std::string>& notes) {
    using radiosity::Mirrors;
    const auto& method = radiosity::exchange_method(settings.solve.exchange);
    const bool any = std::ranges::any_of(scene.materials, [](const radiosity::Material& m) {
        return m.roughness == 0.0 &&
               std::ranges::any_of(m.specular, [](double rho) { return rho > 0.0; });
    });
    const Mirrors asked = settings.mirrors.value_or(Mirrors::walked);
    if (!any || method.mirrors || asked == Mirrors::scattered) return asked;
    if (settings.mirrors)
        root.table("solve", solve_keys(), "[solve]")
            .fail("mirrors",
                  fmt::format("mirrors of [solve] is \"walked\", but rays do not make the "
                              "exchange areas of \"{}\". Give mirrors = \"scattered\", "
                              "or exchange = \"walked\".",
                              method.name));
    notes.push_back(
        fmt::format("exchange = \"{}\" does not follow mirrors: the solve scatters what "
                    "they reflect evenly (solve.mirrors = \"scattered\")",
                    method.name));
    return Mirrors::scattered;
}

bool emits_light(const radiosity::Scene& scene) {
    const auto some = [](const radiosity::Spectrum& values) {
        return std::any_of(values.begin(), values.end(), [](double v) { return v > 0.0; });
    };
    if (!scene.lights.empty() || some(scene.environment)) return true;
    for (const auto& material : scene.materials) {
        if (some(material.emission) || some(material.power) || some(material.flux)) return true;
    }
    for (const auto& medium : scene.media) {
        if (some(medium.emission) || some(medium.heat)) return true;
    }
    return false;
}

enum class Surfaces { read, left_out };

SceneFile read_table(const toml::table& table, const std::filesystem::path& folder,
                     Surfaces surfaces) {
    const TableReader root(table, keys::root(), "the scene");
    check_format(root);
    SceneFile file;
    if (root.has("title")) file.scene.title = root.text("title");
    read_spectrum(root, folder, file.scene);

    Names materials("material"), cameras("camera");
    read_materials(root, materials, file.scene, file.notes);
    if (surfaces == Surfaces::read) read_surfaces(root, folder, materials, file.scene, file.notes);
    read_media(root, folder, file.scene, file.notes);
    read_lights(root, file.scene);
    read_environment(root, file.scene);
    read_cameras(root, cameras, file);

    const Settings settings = read_settings(root);
    file.solve = settings.solve;
    file.tetrahedra = own_tetrahedra(root, settings, folder, file.notes);
    file.mirrors = mirrors_of(root, settings, file.scene, file.notes);
    file.render = settings.render;
    file.tone_map = settings.tone_map;
    file.view_camera = view_camera(root, settings.camera, cameras);
    if (!emits_light(file.scene))
        file.notes.push_back("nothing gives light: the picture will be black");
    file.effective_toml = toml_text(table);
    file.animation = read_animation(root);
    return file;
}

toml::table table_of(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
    toml::table table = parse_toml_file(path, "scene");
    for (const std::string& override : overrides) apply_override(table, override);
    return table;
}

// What a track gave is no --set: a complaint about it names the track's place, and the frame.
SceneFile read_frame(const std::filesystem::path& path, std::vector<std::string> overrides,
                     const std::vector<FrameSetting>& settings, Surfaces surfaces) {
    for (const auto& setting : settings) overrides.push_back(setting.text());
    try {
        return read_table(table_of(path, overrides), path.parent_path(), surfaces);
    } catch (const mesh::InputError& error) {
        const std::string message = error.what();
        for (const auto& setting : settings) {
            const std::string place = "--set " + setting.text() + ": ";
            if (message.starts_with(place))
                fail_at(setting.place,
                        fmt::format("in frame {} of the animation, {}: {}", setting.frame,
                                    setting.text(), message.substr(place.size())));
        }
        throw mesh::InputError(message + (settings.empty()
                                              ? std::string()
                                              : fmt::format(" (In frame {} of the animation.)",
                                                            settings.front().frame)));
    }
}

// Every frame whose values are not those of the one before. Surfaces are read again where a track
// moves one: files of them may be large.
void check_frames(const std::filesystem::path& path, const std::vector<std::string>& overrides,
                  const Animation& animation) {
    const bool moved =
        std::any_of(animation.tracks.begin(), animation.tracks.end(), [](const Track& track) {
            return track.key.starts_with("surface") || track.key.starts_with("\"");
        });
    std::string before;
    for (std::size_t frame = 0; frame < animation.frames; ++frame) {
        const auto settings = settings_of_frame(animation, frame);
        std::string values;
        for (const auto& setting : settings) values += setting.text() + "\n";
        if (frame > 0 && values == before) continue;
        before = values;
        read_frame(path, overrides, settings, moved ? Surfaces::read : Surfaces::left_out);
    }
}

}  // namespace

SceneFile read_scene_file(const std::filesystem::path& path,
                          const std::vector<std::string>& overrides) {
    SceneFile file = read_table(table_of(path, overrides), path.parent_path(), Surfaces::read);
    if (file.animation) check_frames(path, overrides, *file.animation);
    return file;
}

SceneFile read_scene_frame(const std::filesystem::path& path,
                           const std::vector<std::string>& overrides, const Animation& animation,
                           std::size_t frame) {
    return read_frame(path, overrides, settings_of_frame(animation, frame), Surfaces::read);
}

ViewSettings read_view_settings(const std::string& toml,
                                const std::vector<std::string>& overrides) {
    const std::string name = "the solution's scene";
    toml::table table;
    try {
        table = toml::parse(toml, name);
    } catch (const toml::parse_error& error) {
        fail_at(place_of(error.source()), fmt::format("{}. Solve again.", error.description()));
    }
    for (const std::string& override : overrides) {
        if (!override.starts_with("render.") && !override.starts_with("camera."))
            fail_at("--set " + override,
                    "the solution is there already: only keys of render and camera can be set, "
                    "such as render.samples=64 or camera.main.width=1280.");
        apply_override(table, override);
    }
    const TableReader root(table, keys::root(), "the scene");
    SceneFile file;
    Names cameras("camera");
    read_cameras(root, cameras, file);
    const Settings settings = read_settings(root);
    const std::string title = root.has("title") ? root.text("title") : "";
    return {title, std::move(file.cameras), view_camera(root, settings.camera, cameras),
            settings.render, settings.tone_map};
}

std::string scene_file_reference() {
    std::string text;
    for (const KeyTable* table :
         {&keys::root(),       &keys::material(),    &keys::surface(),
          &keys::cuboid(),     &keys::rectangle(),   &keys::face_opening(),
          &keys::opening(),    &keys::rotate(),      &keys::medium(),
          &keys::extinction(), &keys::phase(),       &keys::lens(),
          &keys::light(),      &keys::sun(),         &keys::point(),
          &keys::spot(),       &keys::environment(), &keys::camera(),
          &solve_keys(),       &render_keys(),       &keys::grey_gases(),
          &keys::grey_gas(),   &keys::animation(),   &keys::animation_track()}) {
        text += fmt::format("### {}\n\n| key | value | default | meaning |\n|---|---|---|---|\n",
                            table->title);
        for (const Key& key : table->keys) {
            text += fmt::format("| `{}` | {} | {} | {} |\n", key.name, key.type, key.fallback,
                                key.meaning);
        }
        text += "\n";
    }
    return text;
}

}  // namespace tyndall::cli
