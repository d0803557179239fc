// Exchange areas of patches by hemi-cubes.
#pragma once

#include "radiosity/exchange.h"

namespace tyndall::radiosity {

// Purpose: row i of a patch from hemi-cubes on points of it: every pixel's delta form factor, the
//   integral of cosθ/π over its solid angle, attenuated by the transmittance along the pixel's
//   path, goes to the patch that is seen, and what it loses on the way to the zones passed:
//     S_iS_n = A_i/C Σ_cubes Σ_pixels w T,   S_iV_k = A_i/C Σ_cubes Σ_pixels w T (1 − e^{−κΔs})
//                                                                                     (8), (9)
//   Settings: resolution, centres, random_offsets, projection (cube_rows.h).
// Valid for: patches; zones that see no cosine need a full cube (exchange_full_cube.h).
//   Rows close by construction. Reciprocity comes with centres and resolution.
// Errors: mesh::InputError for a zone, with its medium's name.
// Cost: cube_rows.h; the defaults project 3 × 64² pixels.
// Error: of what a cube sees: as one over the resolution, since edges along the patch's normal run
//   along the sides' pixels (rooms, root mean square: 0.7 % of all at 16 pixels, 0.09 % at 128).
//   That one point stands for the patch: as the patch's size over the distance, squared; it does
//   not fall with the resolution. Random offsets are right in the mean but for the order 2 in
//   pixels.
// Source: Cohen & Greenberg (1985); in media Rushmeier & Torrance (1987).
void exchange_hemicube(const Discretization& discretization, std::span<const ElementId> rows,
                       const ExchangeOptions& options, const RowSink& sink);

}  // namespace tyndall::radiosity
