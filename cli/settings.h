// [solve] and [render]: how to compute, not what.
#pragma once

#include <optional>
#include <string>

#include "cli/toml_reader.h"
#include "radiosity/enclosure.h"
#include "radiosity/options.h"
#include "render/options.h"

namespace tyndall::cli {

struct Settings {
    radiosity::SolveOptions solve;
    std::optional<std::string> camera;          // solve.camera as given
    std::string mesh;                           // solve.mesh as given; empty: none
    std::optional<radiosity::Mirrors> mirrors;  // solve.mirrors as given
    render::RenderOptions render;
    render::ToneMapOptions tone_map;
};

const KeyTable& solve_keys();
const KeyTable& render_keys();

// Reads both tables of the scene file's root where they are given; defaults otherwise.
// render.seed is solve.seed. Throws mesh::InputError.
Settings read_settings(const TableReader& root);

// "2 GB", "500 MB", "1.5 GiB", "4096" → bytes; none if it is not a size.
std::optional<double> bytes_of(std::string_view text);

}  // namespace tyndall::cli
