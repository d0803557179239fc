// Regular grids from NumPy's .npy files.
#pragma once

#include <filesystem>

#include "radiosity/regular_grid.h"

namespace tyndall::radiosity {

// Purpose: a grid of three dimensions from a file of versions 1 to 3 of the format, of float32 or
//   float64, in C or Fortran order. array[i, j, k] is the value at point i along x, j along y, k
//   along z; the first points lie on the box's low faces, the last on its high ones.
// Errors: mesh::InputError: no such file; no .npy file, cut short, longer than its array; another
//   type than little-endian floats; not three dimensions; more than 2^27 values; what RegularGrid
//   refuses.
// Cost: the file's bytes, and four a value.
// Source: NumPy, numpy.lib.format.
RegularGrid read_npy_grid(const std::filesystem::path& path, Point low, Point high);

}  // namespace tyndall::radiosity
