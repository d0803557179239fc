// The base mesh as a Gmsh file with names: to be looked at, changed, and taken as `solve.mesh`.
#pragma once

#include "exports/exported_files.h"
#include "radiosity/enclosure.h"

namespace tyndall::exports {

// Purpose: MSH 4.1, text: the base tetrahedra of all regions, and the triangles of surfaces and
//   openings between them. Physical names: of the triangles that of the side in front
//   ("room.floor"), "openings" where light passes; of the tetrahedra that of their medium, "empty"
//   and "solid". Numbers have 17 digits, so that a mesh that is read again is the same.
// Errors: mesh::InputError where bodies stand in the tetrahedra, whose triangles are on no face.
// Source: Gmsh reference manual, "MSH file format", 4.1.
// Cost: O(tets).
ExportedFiles gmsh_file(const radiosity::Enclosure& enclosure);

}  // namespace tyndall::exports
