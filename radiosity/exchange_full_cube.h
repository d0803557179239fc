// Exchange areas of zones by full cubes, and of patches by hemi-cubes.
#pragma once

#include "radiosity/exchange.h"

namespace tyndall::radiosity {

// Purpose: row k of a zone from full cubes around points of it: the delta factor of a pixel is its
//   solid angle over 4π, without the cosine of a surface, attenuated as in a hemi-cube:
//     V_kS_j = c_k/C Σ_cubes Σ_pixels w T,   V_kV_m = c_k/C Σ_cubes Σ_pixels w T (1 − e^{−κΔs})
//   with c_k = 4 κ_t V_k; V_kV_k is among them                                        (9), (10)
//   Rows of patches are those of exchange_hemicube: together they are the method of 1987.
//   Settings: resolution, centres, random_offsets, projection (cube_rows.h).
// Valid for: all elements. Rows close by construction.
// Cost: cube_rows.h; the defaults project 6 × 64² pixels.
// Error: of what a cube sees, as one over the resolution where edges run along pixels, and as its
//   power −3/2 where they do not; random offsets are right in the mean. One cube at the centroid is
//   not enough: of cubes of one optical length V_kV_k is then 38 % too large and V_kV_m of
//   neighbours 26 % too small, whatever the resolution: from the middle a zone surrounds the eye
//   more than from its other points. With more centres the error falls: 0.1 % at 512.
// Source: Rushmeier & Torrance (1987).
void exchange_full_cube(const Discretization& discretization, std::span<const ElementId> rows,
                        const ExchangeOptions& options, const RowSink& sink);

}  // namespace tyndall::radiosity
