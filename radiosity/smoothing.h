// Smoothing of exchange areas: rows of any method made to be reciprocal and to close, both at once.
#pragma once

#include <span>
#include <string_view>

#include "radiosity/exchange.h"

namespace tyndall::radiosity {

// Purpose: S', the symmetric matrix nearest to S whose rows close, with no entry below 0:
//     S'_ij = S'_ji,   Σ_j S'_ij = c_i.
//   Outside counts as one more element with S'_out,i = S'_i,out; its own row need not close, so
//   that its multiplier is 0. Let S̄_ij = (S_ij + S_ji)/2. With multipliers λ_i of the elements
//     least squares: Σ (S'_ij − S_ij)² / S̄_ij² is least:  S'_ij = max(0, S̄_ij + S̄_ij² (λ_i + λ_j))
//     scaling:       S'_ij = f_i f_j S̄_ij,  f_i = e^{λ_i}                             (32), (33)
//   An entry that neither S_ij nor S_ji has stays 0. Least squares without the bound can make
//   entries negative; setting these to 0 and doing it again, as is usual, need not end at the least
//   change. Here the bound belongs to the problem: entries at 0 are left out of the linear system,
//   and come back where the multipliers ask for it. `clamped` counts them at the end.
// Method: Newton's on the multipliers, with conjugate gradients for its sparse linear systems
//     Σ_j w_ij (δλ_i + δλ_j) = c_i − Σ_j S'_ij,   w = S̄² where S' > 0, or S'           (34)
//   which is one system for least squares while nothing is at 0; scaling begins with the symmetric
//   iteration of Sinkhorn, f_i ← √(f_i c_i / Σ_j S̄_ij f_j).
// Shapes and units: rows of all elements, without levels [m^2]. Kept in double precision, values
//   and remainders, so that rows close to 1e-12. Elements without capacity have no entries but 0.
//   Moments, if there are any, are scaled with their entries: the mean place in j stays what it
//   was; entries that row i did not have are at j's centroid. So radiance may be linear and the
//   furnace holds, but power balances to what moments leave only. With constants it balances.
// Valid for: any method. S_ij and S_ji are two estimates of one thing, and their mean is the better
//   for it; what then misses a row's capacity is spread over all its entries, right or wrong. Rows
//   of few rays, whose S_ij and S_ji have little in common, move far: the report says how far.
// Errors: mesh::InputError for rows with levels. Rows that cannot be made to close (an element that
//   so few rays know that what it sees has less capacity than itself) are left at the least miss
//   found, `converged` false.
// Cost: 40 (scaling) to 110 (least squares) passes over the entries measured, in parallel: two to
//   five times the time of walked rows of 64 rays. The union of both patterns has up to twice the
//   entries, of 12 bytes instead of 8: with 18 000 elements 22 bytes an entry as made in the end,
//   45 meanwhile (45 and 70 with moments). The same bits at any number of threads.
// Source: after Larsen & Howell (1986) for least squares; Sinkhorn & Knopp (1967) and Knight & Ruiz
//   (2013) for symmetric scaling.
ExchangeAreas smooth(ExchangeAreas raw, const Elements& elements, std::size_t band,
                     Smoothing method);

// Of two bands' rows, the worse in everything.
SmoothingReport worse_of(const SmoothingReport& a, const SmoothingReport& b);

// Errors: mesh::InputError where rows with this level of detail are to be smoothed.
void check_smoothing(Smoothing method, double row_detail);

// "least_squares", "scaling", "none". Errors: mesh::InputError if there is none of that name.
std::span<const std::string_view> smoothing_names();  // in the order of Smoothing
std::string_view smoothing_name(Smoothing method);
Smoothing smoothing_named(std::string_view name);

}  // namespace tyndall::radiosity
