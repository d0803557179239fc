// Scene files: TOML in, a scene, its cameras and the settings out.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/animation.h"
#include "radiosity/enclosure.h"
#include "radiosity/options.h"
#include "radiosity/scene.h"
#include "render/camera.h"
#include "render/options.h"

namespace tyndall::cli {

struct SceneFile {
    radiosity::Scene scene;
    std::vector<render::Camera> cameras;
    radiosity::SolveOptions solve;
    std::filesystem::path tetrahedra;  // solve.mesh where solve.start is "mesh"; empty otherwise
    radiosity::Mirrors mirrors = radiosity::Mirrors::walked;  // solve.mirrors, or what is possible
    std::string view_camera;  // whose picture matters: solve.camera, else the first; "" for none
    render::RenderOptions render;
    render::ToneMapOptions tone_map;
    std::vector<std::string> notes;  // what was mended: "part.obj: welded 12 of 48 vertices"
    std::string effective_toml;      // the scene as TOML with the overrides applied
    std::optional<Animation> animation;
};

// Reads a scene file, with `overrides` ("material.plaster.reflectance=0.3") applied before.
// Throws mesh::InputError: "file:line:column: what is wrong (the value), in which named thing. What
// to do."; for an overridden value the place is "--set key=value".
// What needs the mesh to be seen (a medium's point in a wall, say) make_enclosure finds out.
// Where the scene has an animation, every frame of it is read as well, so that all are known to be
// good; what is returned has the values that the file itself gives.
SceneFile read_scene_file(const std::filesystem::path& path,
                          const std::vector<std::string>& overrides = {});

// The scene in a frame of its animation: the tracks' values are applied after the overrides. Throws
// as read_scene_file does; a value that a track gave has the track's place, and names its frame.
SceneFile read_scene_frame(const std::filesystem::path& path,
                           const std::vector<std::string>& overrides, const Animation& animation,
                           std::size_t frame);

// What of a scene a picture depends on, beyond the solution.
struct ViewSettings {
    std::string title;
    std::vector<render::Camera> cameras;
    std::string view_camera;  // as in SceneFile
    render::RenderOptions render;
    render::ToneMapOptions tone_map;
};

// Reads cameras and [render] of a scene's text (SceneFile::effective_toml), with overrides of
// render.* and camera.* keys. Throws mesh::InputError as read_scene_file does.
ViewSettings read_view_settings(const std::string& toml, const std::vector<std::string>& overrides);

// Every key a scene file may hold, as Markdown tables: the reference in the documentation.
std::string scene_file_reference();

}  // namespace tyndall::cli
