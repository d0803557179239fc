// What an export consists of: one file, those that it names, and what is to be known of them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "render/camera.h"

namespace tyndall::exports {

// A file beside the main one.
struct NamedFile {
    std::string name;  // relative to the main file's folder: "room_parts/floor.ply"
    std::string bytes;
};

struct ExportedFiles {
    std::string main;                // bytes
    std::vector<NamedFile> beside;   // that `main` names
    std::vector<std::string> notes;  // sentences: what is not the same as in the scene

    // Adds a sentence that is not there yet.
    void note(const std::string& sentence);
};

// Errors: mesh::InputError where there is no camera, which a path tracer's scene cannot be without.
void require_camera(std::span<const render::Camera> cameras);

}  // namespace tyndall::exports
