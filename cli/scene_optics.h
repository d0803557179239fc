// Materials, media, lights and the environment of a scene file.
#pragma once

#include <filesystem>

#include "cli/names.h"
#include "cli/toml_reader.h"
#include "radiosity/scene.h"

namespace tyndall::cli {

// Each reads its part of the root table into the scene, whose `bands` is set. Units are converted
// to those of radiosity/scene.h: exitance / π, temperature to (1−ρ)σT⁴/π (materials) or σT⁴/π
// (media), each band's share of it by scene.spectral; partial pressures to extinction and albedo;
// degrees to radians; directions to unit length. All throw mesh::InputError with place and name.
// `notes`: temperatures beyond those that weights of grey gases are valid for.
void read_materials(const TableReader& root, Names& names, radiosity::Scene& scene,
                    std::vector<std::string>& notes);
// `folder`: that of the scene file.
void read_media(const TableReader& root, const std::filesystem::path& folder,
                radiosity::Scene& scene, std::vector<std::string>& notes);
void read_lights(const TableReader& root, radiosity::Scene& scene);
void read_environment(const TableReader& root, radiosity::Scene& scene);

// A unit vector from any length but 0.
glm::dvec3 read_direction(const TableReader& reader, std::string_view key);

}  // namespace tyndall::cli
