// Exchange areas of patches by one plane above each.
#pragma once

#include "radiosity/exchange.h"

namespace tyndall::radiosity {

// Purpose: row i of a patch as exchange_hemicube makes it, from one projection instead of five:
// onto
//   a square parallel to the patch whose edge is 14 times its distance (single_plane_half_width).
//   The directions that miss it are grazing, and their cosine is small: they are left out.
//   Settings: resolution (pixels along the square's edge), centres, random_offsets, projection
//   (cube_rows.h).
// Valid for: patches. A zone sees no cosine, so that grazing directions count as much as others.
//   Rows do not close: every row lacks the same 1.6 %, which goes nowhere and is in closure_error
//   and in the energy balance. It is not spread over what is seen: that has no claim to it.
// Errors: mesh::InputError for a zone, with its medium's name.
// Cost: cube_rows.h; a third of a hemi-cube's pixels.
// Error: pixels are 7 times as wide as a hemi-cube's: 0.5 % of parallel unit squares at 64 pixels
//   along the edge, 0.01 % at 256 (32 centres, random offsets).
// Source: Sillion & Puech (1989), whose plane is subdivided as a scene needs it; here pixels are
//   equal squares.
void exchange_single_plane(const Discretization& discretization, std::span<const ElementId> rows,
                           const ExchangeOptions& options, const RowSink& sink);

}  // namespace tyndall::radiosity
