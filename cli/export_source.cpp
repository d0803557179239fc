#include "cli/export_source.h"

#include "radiosity/solution_file.h"

namespace tyndall::cli {

ExportSource export_source(const std::string& from, const CommonFlags& flags) {
    ExportSource source;
    if (std::filesystem::path(from).extension() == ".toml") {
        ProgressLine progress(flags);
        const SceneFile file = load_scene(from, flags);
        source.enclosure = mesh_scene(file, progress);
        source.settings = {file.scene.title, file.cameras, file.view_camera, file.render,
                           file.tone_map};
        return source;
    }
    auto file = radiosity::read_solution(solution_path(from));
    const auto scene = attached_scene(file.attachments);
    if (!scene.empty()) source.settings = read_view_settings(scene, override_texts(flags));
    source.enclosure = file.solution.enclosure;
    source.solution = std::move(file.solution);
    return source;
}

}  // namespace tyndall::cli
