// The meshes of a run's passes in OUT/passes/: kept, gone on with, frozen.
#pragma once

#include <filesystem>
#include <string>

#include "cli/scene_file.h"
#include "radiosity/adaptive.h"

namespace tyndall::cli {

struct PassChoice {
    bool resume = false;  // go on from the last pass in the folder, if there is one
    std::string replay;   // a pass or solution file whose mesh is taken as it is; "" none
};

struct PassPlan {
    radiosity::Passes passes;
    std::filesystem::path resumed_from;  // the pass that is gone on with; empty: none
};

// What the solve is to do with passes: each is written to FOLDER/passes/01.vtkhdf, 02 … when it is
// finished, so that a run that was stopped or killed can go on. A run that goes on numbers its
// passes from there; no pass is overwritten. Otherwise passes of an earlier run are removed.
// Errors: mesh::InputError: a pass of another scene or of other settings, an unreadable file. That
//   the geometry is the same, solve_adaptively sees to.
PassPlan plan_passes(const SceneFile& file, const std::filesystem::path& folder,
                     const PassChoice& choice);

}  // namespace tyndall::cli
