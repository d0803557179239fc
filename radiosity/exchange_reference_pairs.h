// Exchange areas by quadrature to a requested tolerance: slow, deterministic, for tests and for
// students.
#pragma once

#include "radiosity/exchange.h"

namespace tyndall::radiosity {

// Purpose: every pair of elements, and outside, as the sum over its faces (35), each integral to
//   the relative error ExchangeOptions::settings.tolerance of the pair's exchange area.
// Valid for: all pairs, touching and identical ones too; any occlusion; media homogeneous in each
//   region. Symmetric by construction (a pair is computed once); rows close to the tolerance.
// Errors: mesh::InputError for a pair whose tolerance was not reached within the work allowed, and
//   for more than 5000 elements.
// Cost: a millisecond to a tenth of a second a pair of faces at 1e-6; with something in the way 10
//   to 100 times that.
// Source: Lambert's closed form; zones by their faces after the radial integral over each ray, as
//   Hottel & Sarofim (1967) tabulate gas zones from surfaces.
void exchange_reference_pairs(const Discretization& discretization, std::span<const ElementId> rows,
                              const ExchangeOptions& options, const RowSink& sink);

}  // namespace tyndall::radiosity
