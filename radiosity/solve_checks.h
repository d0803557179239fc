// What a solve refuses before it begins.
#pragma once

#include "radiosity/adaptive.h"

namespace tyndall::radiosity {

// Errors: mesh::InputError for unknown methods, settings that a method does not know or cannot do
//   with these media, and a mesh to begin with that is of another base mesh.
void check_solve(const Enclosure& enclosure, const SolveOptions& options, const Passes& passes);

}  // namespace tyndall::radiosity
