// The steps that the subcommands share: from a scene to a solution, pictures and a report.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/progress.h"
#include "cli/scene_file.h"
#include "radiosity/adaptive.h"
#include "render/image.h"

namespace tyndall::cli {

// The scene with --set and --seed applied. Throws mesh::InputError.
SceneFile load_scene(const std::string& path, const CommonFlags& flags);

// --set as read_scene_file takes it.
std::vector<std::string> override_texts(const CommonFlags& flags);
// The same with --seed.
std::vector<std::string> scene_overrides(const CommonFlags& flags);

// Conforms and tetrahedralizes; the notes of the scene file go first among the warnings.
std::shared_ptr<const radiosity::Enclosure> mesh_scene(const SceneFile& file,
                                                       ProgressLine& progress);

// Solves, for the view that the scene names; meshes, where that has not been done.
radiosity::Solution solve_scene(const SceneFile& file,
                                std::shared_ptr<const radiosity::Enclosure> enclosure,
                                ProgressLine& progress, const radiosity::Passes& passes = {});
radiosity::Solution solve_scene(const SceneFile& file, ProgressLine& progress,
                                const radiosity::Passes& passes = {});

// The camera of that name, "" the first. Throws mesh::InputError that lists those there are.
const render::Camera& find_camera(const std::vector<render::Camera>& cameras,
                                  const std::string& name);

// A picture by the method that the options name. Throws mesh::InputError for another.
render::Image make_picture(const radiosity::Solution& solution, const render::Camera& camera,
                           const render::RenderOptions& options, ProgressLine& progress);

// A folder for results, made if it is not there; half-written files of killed runs are removed.
// Throws mesh::InputError if it cannot be made or written to: to be called before long work.
void prepare_folder(const std::filesystem::path& folder);

// The solution file of a folder, or the file itself.
std::filesystem::path solution_path(const std::string& given);

// What a solution file carries for the commands: the scene's text.
std::string attachments_json(const SceneFile& file);
// The scene's text again; "" if the file came from elsewhere. Throws mesh::InputError.
std::string attached_scene(const std::string& attachments);

}  // namespace tyndall::cli
