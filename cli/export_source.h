// What `tyndall export` writes of: a solution, or a scene that is meshed and not solved.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "cli/job.h"

namespace tyndall::cli {

struct ExportSource {
    std::optional<radiosity::Solution> solution;  // none: a scene file was given
    std::shared_ptr<const radiosity::Enclosure> enclosure;
    ViewSettings settings;
};

// Purpose: what is known of a scene file (.toml), or of a solution (a folder or a file).
// Errors: mesh::InputError of reading and meshing.
ExportSource export_source(const std::string& from, const CommonFlags& flags);

}  // namespace tyndall::cli
