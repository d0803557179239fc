// Gathering, one element after the other.
#pragma once

#include "radiosity/solver.h"

namespace tyndall::radiosity {

// Purpose: the linear system by the iteration of Gauss and Seidel: each element in turn gathers
// from
//   what all hold by now, what it sends to itself (a zone does) summed up at once:
//     x_i ← x_i + ω ρ_i / (1 − a_i S_ii/c_i),   ρ_i = s_i + a_i/c_i Σ_j S_ij x_j − x_i    (38)
//   ω from 1 to 2 is successive over-relaxation.
// Valid for: ω from 0 to 2. Converges where Jacobi's does, faster: about half its iterations.
// Errors: none; not converged is a result, and so is an iteration that diverges: it ends then.
// Cost: one pass over the entries an iteration, by one thread: each element waits for the one
//   before. A second pass, in parallel, for the residual.
// Source: Cohen & Greenberg (1985) for radiosity; Young (1954) for over-relaxation.
SolverResult solve_gauss_seidel(const LinearProblem& problem, const SolverOptions& options);

}  // namespace tyndall::radiosity
