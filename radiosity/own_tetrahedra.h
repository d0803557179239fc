// What is to be said of a base mesh that came from the user's own file.
#pragma once

#include <string>

#include "mesh/tet_file_fit.h"
#include "radiosity/enclosure.h"

namespace tyndall::radiosity {

// Purpose: warnings of `enclosure`, whose mesh `fitted` was: what was mended in the file, and how
//   much of the regions that light can be in the file left to TetGen. Cost: O(filled tets).
void note_own_tetrahedra(const mesh::FittedMesh& fitted, const std::string& file,
                         Enclosure& enclosure);

}  // namespace tyndall::radiosity
