// Rows of methods that take elements two at a time.
#pragma once

#include <functional>

#include "radiosity/exchange.h"

namespace tyndall::radiosity {

// S of a pair, i ≤ j; j may be outside [m^2]. Called in parallel.
using PairArea = std::function<double(ElementId i, ElementId j)>;

// Every pair that the rows and `options.columns` ask for, computed once for both its rows.
// `lacking`: outside is what a row lacks (c_i − Σ_j S_ij) in an open enclosure, so that all columns
// are computed where it is asked for; else it is a pair as others are.
// Errors: mesh::InputError beyond 5000 elements: pairs are kept, and take long; and what `area`
//   throws, that of the first pair in order.
void pair_rows(const Discretization& discretization, std::span<const ElementId> rows,
               const ExchangeOptions& options, bool lacking, const PairArea& area,
               const RowSink& sink);

}  // namespace tyndall::radiosity
