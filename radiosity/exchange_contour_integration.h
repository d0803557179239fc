// Exchange areas of polygons from their contours.
#pragma once

#include "radiosity/exchange.h"

namespace tyndall::radiosity {

// Purpose: S_iS_j of patches in closed form but for one integral over an edge (contour.h), polygons
//   cut where the plane of one crosses the other. Outside is what a row lacks.
// Valid for: patches with nothing between them that is opaque, in empty space. Through a medium
//   only with ExchangeOptions::settings.uniform_transmittance: times the transmittance between the
//   polygons' middles, too large or too small by as much as it varies over them: for unit squares
//   1 m apart 11 % too large at an extinction of 1/m, 1.1 % at 0.1/m.
// Errors: mesh::InputError for every other pair; it names the pair and the methods that can do it.
// Error: some 1e-14 of the smaller polygon's area; symmetric by construction.
// Cost: some 1e-5 s a pair of edges.
// Source: Sparrow & Cess (1970); Goral et al. (1984).
void exchange_contour_integration(const Discretization& discretization,
                                  std::span<const ElementId> rows, const ExchangeOptions& options,
                                  const RowSink& sink);

}  // namespace tyndall::radiosity
