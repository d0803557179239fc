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

// What the solve is to do with passes: each is written to FOLDER/passes/01.vtkhdf, 02 … when it is
// finished, so that a run that was stopped or killed can go on. Passes of an earlier run are
// removed unless it is gone on with. Errors: mesh::InputError: a pass of another scene, an
// unreadable file to replay.
radiosity::Passes passes_of(const SceneFile& file, const std::filesystem::path& folder,
                            const PassChoice& choice);

}  // namespace tyndall::cli
