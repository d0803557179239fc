// Gathering, all elements at once.
#pragma once

#include "radiosity/solver.h"

namespace tyndall::radiosity {

// Purpose: the linear system by Jacobi's iteration: every element gathers from what all have held
//   before,
//     x ← x + ω (s + a/c S x − x),                                                        (37)
//   from x = 0. With ω = 1 the k-th iterate is the light of k bounces.
// Valid for: ω from 0 to 2; the error falls by the spectral radius of a/c S an iteration, which is
//   at most the largest a, less what escapes. Where fog and walls scatter nearly all, slow.
// Errors: none; not converged is a result, and so is an iteration that diverges: it ends then.
// Cost: one pass over the entries an iteration, in parallel.
// Source: the gathering of Goral et al. (1984) and of the zonal method, Hottel & Sarofim (1967).
SolverResult solve_jacobi(const LinearProblem& problem, const SolverOptions& options);

}  // namespace tyndall::radiosity
