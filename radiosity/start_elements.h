// The elements that the first coarse solution of a solve has.
#pragma once

#include "radiosity/element_mesh.h"
#include "radiosity/elements.h"
#include "radiosity/options.h"

namespace tyndall::radiosity {

// Bisects a new mesh as far as the solve begins with: none for a single zone; down to element_size,
// or to what a room needs; nothing where the base mesh is asked for.
void make_initial_mesh(ElementMesh& mesh, const SolveOptions& options);

// Start::single_zone: one zone a part of a medium that light can cross, one patch a side of an
//   input polygon; everything finer is then recomputed from that first solution.
// Every other start: the forest's leaves.
Elements start_elements(const Enclosure& enclosure, const Forest& forest, Start start);

}  // namespace tyndall::radiosity
