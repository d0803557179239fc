// The extinction of a medium in a scene file: a number, an expression, or a grid from a file.
#pragma once

#include <filesystem>

#include "cli/toml_reader.h"
#include "radiosity/scene.h"

namespace tyndall::cli {

// Reads `extinction` of a [[medium]]; `folder`: that of the scene file, to which paths are
// relative. Errors: mesh::InputError with place and name.
void read_extinction(const TableReader& medium, const std::filesystem::path& folder,
                     std::size_t bands, radiosity::Medium& result);

}  // namespace tyndall::cli
