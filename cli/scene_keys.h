// Every key of a scene file but those of [solve] and [render] (cli/settings.h): one list for the
// reader's errors and for the reference in the documentation.
#pragma once

#include "cli/toml_reader.h"

namespace tyndall::cli::keys {

const KeyTable& root();
const KeyTable& material();
const KeyTable& surface();
const KeyTable& cuboid();  // room = { … }, box = { … }
const KeyTable& rectangle();
const KeyTable& opening();       // of a rectangle
const KeyTable& face_opening();  // of a room or box
const KeyTable& rotate();
const KeyTable& medium();
const KeyTable& extinction();  // of a medium, a grid
const KeyTable& phase();
const KeyTable& light();
const KeyTable& sun();
const KeyTable& point();
const KeyTable& spot();
const KeyTable& environment();
const KeyTable& camera();
const KeyTable& lens();
const KeyTable& grey_gases();  // the file that grey_gases names
const KeyTable& grey_gas();
const KeyTable& animation();
const KeyTable& animation_track();

}  // namespace tyndall::cli::keys
