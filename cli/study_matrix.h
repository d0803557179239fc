// From a study's axes to its runs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/common_flags.h"
#include "cli/scene_file.h"
#include "cli/study_file.h"

namespace tyndall::cli {

struct StudyRun {
    std::vector<PlacedSetting> overrides;  // all: of [set], of the command line, of the axes
    std::vector<std::string> cells;        // the value of each of axis_keys(); "": not set
    std::string slug;                      // of the run's folder, unique in the study
    std::string curve;                     // what it has in common with those of its curve
    std::optional<double> along;           // value on the axis that its curve follows
    // Those of the axes that change what is to be found, not how: all but solve.* and render.*.
    std::vector<PlacedSetting> scene_overrides;
    std::string scene_slug;  // of these; "" for none

    std::vector<std::string> override_texts() const;
};

// The keys of all axes in the order of their first appearance: the columns of tables.
std::vector<std::string> axis_keys(const Study& study);

// Overrides for every run: [set], then --set and --seed.
std::vector<PlacedSetting> common_settings(const Study& study, const CommonFlags& flags);

// Purpose: the runs, matrix by matrix, the last axis fastest.
// Errors: mesh::InputError if a key of --set is an axis.
std::vector<StudyRun> expand(const Study& study, const CommonFlags& flags);

// Purpose: the scene with overrides applied.
// Errors: mesh::InputError of read_scene_file, with the places that the overrides come from.
SceneFile scene_with(const Study& study, const std::vector<PlacedSetting>& overrides);

}  // namespace tyndall::cli
