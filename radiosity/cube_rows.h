// Rows by projection onto faces around points of an element: what hemi-cube, full cube and single
// plane share.
#pragma once

#include "radiosity/cube_faces.h"
#include "radiosity/exchange.h"

namespace tyndall::radiosity {

// The faces around points of patches and of zones; none: the method makes no such rows.
struct CubeKinds {
    std::vector<CubeFace> patches, zones;
};

// Purpose: row i from what is seen through the pixels of cubes that stand on points of element i:
//     S_ij = c_i/C Σ_cubes Σ_pixels w · (share of the pixel that goes to j)
//   with the pixels' delta form factors w (cube_faces.h) and shares as in item_buffer.h.
// Settings (ExchangeSettings):
//   centres C   1: the centroid, or if that is outside the element (a ring) the centroid of the
//               member nearest to it; more: points of a low-discrepancy set, the same for all
//               elements and seeds.
//   random_offsets   every cube stands on a random point of the element, and is turned by chance:
//   by
//               any angle about a patch's normal, in space for a zone. Seeded by options.seed and
//               element. Otherwise all cubes are turned alike, those of zones along the axes.
//   projection  z_buffer: an item buffer (item_buffer.h); walked: a walk through each pixel's
//               middle. They find the same but for pixels whose middle lies on an edge.
// Cost: z_buffer: per cube the elements, and the pixels in the rectangle around each, hidden or
// not;
//   walked: pixels × tets crossed. The walk was faster in all cubes of cells measured (resolutions
//   32 to 256): 1.1 to 1.3 times at 600 elements, 1.3 to 2 at 7000, 1.8 to 2.4 at 53 000.
// Errors: none of its own; methods refuse what they cannot do.
void rows_by_cubes(const Discretization& discretization, std::span<const ElementId> rows,
                   const ExchangeOptions& options, const RowSink& sink, const CubeKinds& kinds);

// Refuses rows of zones. Errors: mesh::InputError that names the first zone's medium, with `why` at
// its end.
void require_patches(const Discretization& discretization, std::span<const ElementId> rows,
                     std::string_view method, std::string_view why);

}  // namespace tyndall::radiosity
