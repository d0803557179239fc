// What the bands of a scene are: wavelengths, or the grey gases of a file.
#pragma once

#include <filesystem>

#include "cli/toml_reader.h"
#include "radiosity/scene.h"

namespace tyndall::cli {

// Reads bands, band_edges and grey_gases of the root table into the scene: its `bands` and
// `spectral`. Files are relative to `folder`. Throws mesh::InputError with place and name.
void read_spectrum(const TableReader& root, const std::filesystem::path& folder,
                   radiosity::Scene& scene);

// Reads a file of grey gases (docs/guide/09-heat.md): TOML, format = 1, `temperatures`, `pressure`
// and a [[gas]] each with `absorption` and `weights`.
// Throws mesh::InputError with file:line:column: what cannot be read; a weight below 0 somewhere
// between the temperatures, or weights whose sum is above 1.
radiosity::GreyGases read_grey_gases(const std::filesystem::path& path);

}  // namespace tyndall::cli
