// Smoothing of exchange areas: rows of any method made to be reciprocal and to close, both at once.
#pragma once

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
//   was; entries that row i did not have are at j's centroid. Linear radiance so remains, the
//   furnace too, but power balances to what moments leave, as without smoothing.
// Valid for: any method. It moves what is wrong onto all entries alike and makes no row better that
//   was bad: with few rays S_ij and S_ji of small elements have little in common, and rows move by
//   as much. The report says how far.
// Errors: mesh::InputError for rows with levels. Rows that cannot be made to close (an element that
//   so few rays know that what it sees has less capacity than itself) are left at the least miss
//   found, `converged` false.
// Cost: some tens of passes over the entries, in parallel; about 60 bytes an entry meanwhile, and
//   12 in the end, where rows as made have 8. The same bits at any number of threads.
// Source: Larsen & Howell (1986), least squares with these weights; Sinkhorn (1967), Knight & Ruiz
//   (2013) for symmetric scaling.
ExchangeAreas smooth(ExchangeAreas raw, const Elements& elements, std::size_t band,
                     Smoothing method);

// Of two bands' rows, the worse in everything.
SmoothingReport worse_of(const SmoothingReport& a, const SmoothingReport& b);

// Errors: mesh::InputError where rows with this level of detail are to be smoothed.
void check_smoothing(Smoothing method, double row_detail);

// "least_squares", "scaling", "none". Errors: mesh::InputError if there is none of that name.
std::string_view smoothing_name(Smoothing method);
Smoothing smoothing_named(std::string_view name);

}  // namespace tyndall::radiosity
