// BiCGSTAB: the other Krylov method.
#pragma once

#include "radiosity/solver.h"

namespace tyndall::radiosity {

// Purpose: the linear system (I − a/c S) x = s by stabilized bi-conjugate gradients: as GMRES,
// without
//   a basis to keep, for a residual that need not fall at every step. The loop is our own, on
//   Eigen's vectors, because Eigen's keeps no history.
// Valid for: every a ≤ 1 with some loss. Begins anew where two directions have come to be
//   orthogonal.
// Errors: none; not converged is a result.
// Cost: two passes over the entries a step, each counted as one iteration, in parallel. Memory:
// eight
//   vectors.
// Source: Van der Vorst (1992).
SolverResult solve_bicgstab(const LinearProblem& problem, const SolverOptions& options);

}  // namespace tyndall::radiosity
