#include "cli/job.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "cli/completion.h"
#include "cli/suggestion.h"
#include "cli/wrong_file.h"
#include "mesh/file_bytes.h"
#include "mesh/input_error.h"
#include "radiosity/adaptive.h"
#include "render/renderers.h"

namespace tyndall::cli {

namespace fs = std::filesystem;
using mesh::InputError;

std::vector<std::string> override_texts(const CommonFlags& flags) {
    std::vector<std::string> texts;
    for (const auto& setting : flags.settings) texts.push_back(setting.key + "=" + setting.value);
    return texts;
}

std::vector<std::string> scene_overrides(const CommonFlags& flags) {
    auto overrides = override_texts(flags);
    if (flags.seed) overrides.push_back(fmt::format("solve.seed={}", *flags.seed));
    return overrides;
}

// A key without its table, as in --set error=0.01: which one is meant.
static void check_setting_keys(const CommonFlags& flags) {
    if (flags.settings.empty()) return;
    const auto keys = settable_keys();
    std::vector<std::string> last;  // without their tables
    for (const auto& key : keys) last.push_back(key.substr(key.find('.') + 1));
    const std::vector<std::string_view> views(last.begin(), last.end());
    for (const auto& setting : flags.settings) {
        if (setting.key.find('.') != setting.key.npos) continue;
        if (scene_has_key(setting.key)) continue;
        if (const auto near = nearest(setting.key, views)) {
            const auto which = std::find(last.begin(), last.end(), *near) - last.begin();
            throw InputError(fmt::format(
                "--set {}={}: the scene has no key \"{}\". Did you mean \"{}\"?", setting.key,
                setting.value, setting.key, keys[static_cast<std::size_t>(which)]));
        }
    }
}

SceneFile load_scene(const std::string& path, const CommonFlags& flags) {
    require_scene(path);
    check_setting_keys(flags);
    return read_scene_file(path, scene_overrides(flags));
}

std::shared_ptr<const radiosity::Enclosure> mesh_scene(const SceneFile& file,
                                                       ProgressLine& progress) {
    radiosity::report(progress.callback(), {"mesh", 0.0, 0, 0.0});
    auto enclosure = radiosity::make_enclosure(
        file.scene, {.tetrahedra = file.tetrahedra, .mirrors = file.mirrors});
    enclosure.warnings.insert(enclosure.warnings.begin(), file.notes.begin(), file.notes.end());
    return std::make_shared<const radiosity::Enclosure>(std::move(enclosure));
}

radiosity::Solution solve_scene(const SceneFile& file, ProgressLine& progress,
                                const radiosity::Passes& passes) {
    return solve_scene(file, mesh_scene(file, progress), progress, passes);
}

radiosity::Solution solve_scene(const SceneFile& file,
                                std::shared_ptr<const radiosity::Enclosure> enclosure,
                                ProgressLine& progress, const radiosity::Passes& passes) {
    std::optional<radiosity::View> view;
    if (!file.view_camera.empty()) view = find_camera(file.cameras, file.view_camera).view();
    auto solution =
        radiosity::solve_adaptively(enclosure, file.solve, view, progress.callback(), passes);
    if (progress.stopped())
        solution.report.warnings.push_back("stopped on request before the error goal was reached.");
    return solution;
}

const render::Camera& find_camera(const std::vector<render::Camera>& cameras,
                                  const std::string& name) {
    if (cameras.empty())
        throw InputError(
            "the scene has no camera. Add a [[camera]] with eye, target and fov_y to it, and solve "
            "again.");
    if (name.empty()) return cameras.front();
    std::string names;
    for (const auto& camera : cameras) {
        if (camera.name == name) return camera;
        names += (names.empty() ? "" : ", ") + fmt::format("\"{}\"", camera.name);
    }
    throw InputError(fmt::format("there is no camera \"{}\". There is: {}.", name, names));
}

render::Image make_picture(const radiosity::Solution& solution, const render::Camera& camera,
                           const render::RenderOptions& options, ProgressLine& progress) {
    return render::renderer_named(options.method)
        .render(solution, camera, options, progress.callback());
}

void prepare_folder(const fs::path& folder) {
    std::error_code error;
    if (fs::exists(folder, error) && !fs::is_directory(folder, error))
        throw InputError(
            fmt::format("cannot write into '{}': it is a file. Give a folder for the results.",
                        folder.string()));
    fs::create_directories(folder, error);
    if (error)
        throw InputError(
            fmt::format("cannot make the folder '{}': {}.", folder.string(), error.message()));
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
        throw InputError(fmt::format("cannot write into the folder '{}': {}.", folder.string(),
                                     std::strerror(errno)));
    mesh::remove_unfinished(folder);
}

fs::path solution_path(const std::string& given) {
    const fs::path path(given);
    std::error_code ignored;
    if (!fs::is_directory(path, ignored)) {
        require_solution(path);
        return path;
    }
    const auto file = path / "solution.vtkhdf";
    if (!fs::exists(file, ignored))
        throw InputError(
            fmt::format("the folder '{}' holds no solution.vtkhdf. Make one: tyndall solve SCENE "
                        "-o '{}'.",
                        given, given));
    return file;
}

std::string attachments_json(const SceneFile& file) {
    const nlohmann::ordered_json json{{"scene", file.effective_toml}};
    return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string attached_scene(const std::string& attachments) {
    try {
        return nlohmann::json::parse(attachments).value("scene", std::string());
    } catch (const nlohmann::json::exception& error) {
        throw InputError(fmt::format(
            "what is attached to the solution is no JSON ({}). Solve again.", error.what()));
    }
}

}  // namespace tyndall::cli
