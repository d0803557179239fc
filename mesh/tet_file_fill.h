// What lies between the tetrahedra of a file and the hull, filled by TetGen.
#pragma once

#include <span>

#include "mesh/base_mesh_build.h"
#include "mesh/tet_file_surfaces.h"
#include "mesh/tetrahedralize.h"

namespace tyndall::mesh {

// The corners below number the file's nodes, then the new points.
struct Filling {
    std::vector<Point> points;  // new ones, numbered behind the file's nodes [m]
    std::vector<std::array<std::uint32_t, 4>> tets;
    std::vector<SurfaceFace> faces;  // of the facets outside
};

// Purpose: tets between the boundary of the file's (`faces` marked so) and the hull that keep the
//   boundary's faces and hold the facets `outside`. TetGen fills all of the hull with its faces
//   unsplit (-Y); what comes to lie inside the file's tets is thrown away.
// Errors: InputError with the file's name and a tet near the place. Cost: TetGen's.
Filling fill_hull(const TetFile& file, const ConformingComplex& complex, const FittedNodes& nodes,
                  std::span<const TetFace> faces, std::span<const FacetId> outside,
                  const tetgen::Hull& hull, const TetrahedralizeOptions& options);

}  // namespace tyndall::mesh
