// A solution as a VTU file: VTK's XML for unstructured grids.
#pragma once

#include "exports/exported_files.h"
#include "radiosity/solution.h"

namespace tyndall::exports {

// Purpose: the grid that solution.vtkhdf shows (radiosity/element_grid.h) for programs that read no
//   HDF5: the same cells, points and arrays; the names of sides and media as field data.
// Format: VTKFile 1.0, arrays in base64, in blocks of 1 MB that zlib has compressed: XML to the
//   last byte.
// Source: VTK's documentation, "VTK XML file formats".
// Cost: that of element_grid, and zlib's 50 MB/s.
ExportedFiles vtu_file(const radiosity::Solution& solution);

}  // namespace tyndall::exports
