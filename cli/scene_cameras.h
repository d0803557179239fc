// Cameras of scene files.
#pragma once

#include <string>

#include "cli/toml_reader.h"
#include "render/camera.h"

namespace tyndall::cli {

// Errors: mesh::InputError with the place in the file.
render::Camera read_camera(const TableReader& reader, const std::string& name);

}  // namespace tyndall::cli
