#include "exports/exported_files.h"

#include <algorithm>

#include "mesh/input_error.h"

namespace tyndall::exports {

void ExportedFiles::note(const std::string& sentence) {
    if (std::ranges::find(notes, sentence) == notes.end()) notes.push_back(sentence);
}

void require_camera(std::span<const render::Camera> cameras) {
    if (cameras.empty())
        throw mesh::InputError(
            "The scene has no camera, and a path tracer's scene needs one. Add a [[camera]], with "
            "eye, target and fov_y.");
}

}  // namespace tyndall::exports
