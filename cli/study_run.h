// One run of a study: found done, or made by the program as a child.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/progress.h"
#include "cli/scene_file.h"
#include "cli/study_record.h"
#include "render/mesh_pictures.h"

namespace tyndall::cli {

struct StudyJob {
    std::filesystem::path program;  // this one, as `tyndall`
    std::filesystem::path scene;
    std::vector<std::string> overrides;  // as --set takes them
    std::filesystem::path folder;        // of the run
    std::string label;                   // for progress
    std::size_t threads = 0;             // 0: all
    std::optional<render::Plane> slice;  // none: render::default_plane
};

// Purpose: tells runs apart: by the program's version, the scene with its overrides, and the files
//   that it names.
std::string run_key(const std::filesystem::path& scene, const SceneFile& file);

// Whether the folder holds this run, with a result.
bool is_done(const std::filesystem::path& folder, const std::string& key);

// Purpose: the run's record, from its folder if it is done, else from a new run, `tyndall run`, as
//   a child: a crash or a lack of memory there is a failure of that run alone, and CPU time and
//   peak memory are its own. It works in FOLDER.part, which takes FOLDER's place when all is there,
//   pictures of the mesh included. A run that fails leaves a record that says why; it is tried
//   again the next time.
// None if the user asked for a stop.
// Errors: mesh::InputError: the folder cannot be written, the program cannot be started.
std::optional<RunRecord> perform(const StudyJob& job, const SceneFile& file,
                                 ProgressLine& progress);

}  // namespace tyndall::cli
