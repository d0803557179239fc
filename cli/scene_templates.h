// Scene files to begin with: those of templates/, which the build puts into the program.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tyndall::cli {

struct SceneTemplate {
    std::string_view name;     // templates/NAME.toml
    std::string_view purpose;  // for the list
    std::string_view model;    // templates/MODEL, which is written beside the scene; "": none
};

// The default first.
std::span<const SceneTemplate> scene_templates();

// Throws mesh::InputError with the nearest name, or all there are.
const SceneTemplate& scene_template(std::string_view name);

// The scene's text for a file of that name ("room.toml"), which its comments speak of.
std::string scene_of_template(const SceneTemplate& scene, const std::string& file,
                              const std::string& model);

// The text of templates/`name`; empty: there is none.
std::string_view template_text(std::string_view name);

}  // namespace tyndall::cli
