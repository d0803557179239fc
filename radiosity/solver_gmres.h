// GMRES: the default solver.
#pragma once

#include "radiosity/solver.h"

namespace tyndall::radiosity {

// Purpose: the linear system (I − a/c S) x = s by generalized minimal residuals: of all x that k
//   passes can reach, the one that leaves the least. Restarted after 40 steps. The loop is our own,
//   on Eigen's vectors, because Eigen's keeps no history.
// Valid for: every a ≤ 1 with some loss. 10–20 iterations to 1e-6 whatever the size.
// Errors: none; not converged is a result. It ends when a whole cycle of steps gains nothing.
// Cost: one pass over the entries an iteration, in parallel, and O(elements × steps). Memory: two
//   vectors a step, 81 at most.
// Source: Saad & Schultz (1986).
SolverResult solve_gmres(const LinearProblem& problem, const SolverOptions& options);

}  // namespace tyndall::radiosity
