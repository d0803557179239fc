// `reference` of a study file: one for all measures, or one each.
#pragma once

#include <filesystem>
#include <vector>

#include "cli/study_file.h"
#include "cli/toml_reader.h"

namespace tyndall::cli {

// Purpose: gives every measure its reference: a path relative to `folder`, or the overrides of a
//   finer run. In a table, keys with a dot are overrides, and names of measures stand for a
//   reference each.
// Errors: mesh::InputError with place: no reference, a file that is not there or cannot serve the
//   measure, both kinds of keys in one table, an unknown key.
void read_references(const TableReader& root, const std::filesystem::path& folder,
                     std::vector<StudyMeasure>& measures);

}  // namespace tyndall::cli
