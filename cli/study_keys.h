// Every key of a study file: one list for the reader's errors and for the documentation.
#pragma once

#include "cli/toml_reader.h"

namespace tyndall::cli::keys {

const KeyTable& study();
const KeyTable& study_probe();
const KeyTable& study_slice();
// Keys of [axes] besides those of the scene, which have a dot.
const KeyTable& study_axes();

}  // namespace tyndall::cli::keys
