// The user's own tetrahedra as the base mesh of a scene.
#pragma once

#include <span>

#include "mesh/base_mesh.h"
#include "mesh/conform.h"
#include "mesh/tet_file.h"
#include "mesh/tetrahedralize.h"

namespace tyndall::mesh {

// A tet that no file gave.
struct FilledTet {
    Point centroid;  // [m]
    double volume;   // [m^3]
};

struct FittedMesh {
    BaseMesh mesh;
    std::vector<FilledTet> filled;  // between the file's tets and the hull
    std::vector<std::string> notes;
};

// Nodes within this × the scene's diagonal of a facet lie on it, and are moved onto it [-].
inline constexpr double fit_tolerance = 1e-6;

// Purpose: a BaseMesh of the file's tets, in which faces hold every facet of the complex. A face
//   whose corners, centroid and edges' middles lie on a facet becomes one of its base facets; all
//   other faces are free. Where the tets do not fill a box that has all surfaces inside, TetGen
//   fills what is left of the hull (bounding box of both + margin) without touching the file's
//   faces: the file need hold no more than the rooms themselves. A surface that no tet touches goes
//   to TetGen, too; one must be followed all over or not at all, between the edges where surfaces
//   meet.
// Checked: area of every surface (relative 1e-6), orientation after moving, tets that overlap,
//   total volume.
// Errors: InputError with the file's name that says which surface is not followed and where, or
//   which tet (number, line) is at fault.
// Cost: O(n log n), and O(facets outside × tets), and TetGen's for the filling.
FittedMesh fit_tetrahedra(const TetFile& file, const ConformingComplex& complex,
                          std::span<const Polygon> polygons,
                          const TetrahedralizeOptions& options = {});

}  // namespace tyndall::mesh
