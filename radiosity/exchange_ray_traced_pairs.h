// Exchange areas by ray tracing between small pieces of two elements.
#pragma once

#include "radiosity/exchange.h"

namespace tyndall::radiosity {

// Purpose: every exchange area by itself, as an integral over the points of both elements with a
//   shadow ray and the optical depth between them (8)–(10): PairIntegral. Outside is one more
//   element, the open faces of the hull.
// Valid for: any mesh, any occlusion, homogeneous base tets, touching and identical zones; elements
//   that are leaves or clusters. S_ij and S_ji are the same integral, so that reciprocity holds to
//   the last bit; rows close as well as their entries are right.
// Settings: `tolerance`, the relative error that a pair's subdivision aims at. It ends early after
//   PairIntegral::most_rays: where elements touch, errors of 1e-4 to 3e-4 are left then (unit
//   cubes, as one tetrahedron or clusters), 7e-4 in optically thick ones; where edges of shadows
//   decide, some 3e-3, as in what open scenes send outside.
//   `interaction_radius`: pairs are left out whose elements, by the balls around them, are farther
//   apart, and the row's other entries but outside's are scaled so that the row closes: what is far
//   is taken to shine as what is near does in the mean. Outside is always taken in. The error of H
//   is the share that was left out times how far those means differ. Rows close to rounding then,
//   and are no longer reciprocal.
// Cost: of all rows, half of elements² pairs; O(pairs) rays. Pairs are evaluated once where both
//   their rows are asked for and a table of 16 M entries holds these, else once for each. With a
//   radius `columns` are not heeded.
// Source: Wallace, Elmquist & Haines (1989); Borel & Gerstl (1991) for the radius.
void exchange_ray_traced_pairs(const Discretization& discretization,
                               std::span<const ElementId> rows, const ExchangeOptions& options,
                               const RowSink& sink);

}  // namespace tyndall::radiosity
