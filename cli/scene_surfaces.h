// The [[surface]] tables of a scene file.
#pragma once

#include <filesystem>

#include "cli/names.h"
#include "cli/toml_reader.h"
#include "radiosity/scene.h"

namespace tyndall::cli {

// Each face of a shape becomes a radiosity::Surface: "room.floor"; a shape of one face is just
// "name"; an opening is a Surface without material, "name.opening"; groups of a mesh file are
// faces. Mesh files are looked for from `folder`. `notes` takes what was mended in them. Throws
// mesh::InputError with place and name.
void read_surfaces(const TableReader& root, const std::filesystem::path& folder,
                   const Names& materials, radiosity::Scene& scene,
                   std::vector<std::string>& notes);

}  // namespace tyndall::cli
