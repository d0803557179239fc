// Exchange areas by the closed form from points to polygons.
#pragma once

#include "radiosity/exchange.h"

namespace tyndall::radiosity {

// Purpose: S of a patch, seen as polygons, from points of the other element:
//     S_ij = c_i/n Σ_points Σ_parts τ̄ F,   F = 1/π ∫ cosθ dω at a patch, 1/4π ∫ dω in a zone,
//   over the parts of j's polygons that are above the point's horizon and visible from it; F in
//   closed form, τ̄ the mean transmittance over the part. Between patches the mean of both ways, so
//   that S_ij = S_ji.
// Valid for: pairs with a patch, or with outside; any occlusion, any media. Far from the polygon's
//   edges one point is enough; beside it many are.
// Settings: `centres`, the points of an element (1: its centroid); `random_offsets`.
// Errors: mesh::InputError for two zones; it names the pair and the methods that can do it.
// Error: of first to second order in the distance of the points (from points that stand by chance
//   as their number to the −0.74); rows close as well.
// Cost: of a pair, its points × the occluders that overlap the polygon.
// Source: Nishita & Nakamae (1985); Lambert (1760).
void exchange_point_to_polygon(const Discretization& discretization,
                               std::span<const ElementId> rows, const ExchangeOptions& options,
                               const RowSink& sink);

}  // namespace tyndall::radiosity
