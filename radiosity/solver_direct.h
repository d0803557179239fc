// The direct solver: slow, obvious, and what the others are tested against.
#pragma once

#include "radiosity/solver.h"

namespace tyndall::radiosity {

// Elements from which on solve_direct refuses: their matrix takes 288 MB, its factors half a
// minute.
inline constexpr std::size_t most_direct_elements = 6000;

// Purpose: the linear system (I − a/c S) x = s as a dense matrix, gradients and levels written out
// in
//   it, by LU factorization with partial pivoting (Eigen's).
// Valid for: any a and any sign of entries; up to most_direct_elements. A system that is singular
// (a
//   closed scene in which nothing absorbs, with a source) is told by its residual.
// Errors: mesh::InputError above that many elements: names the limit, and what to do.
// Cost: 2/3 n³ operations by one thread, n² doubles of memory. One iteration.
// Source: Goral et al. (1984), who solved the first radiosity systems so.
SolverResult solve_direct(const LinearProblem& problem, const SolverOptions& options);

// Errors: mesh::InputError if there are too many elements.
void check_direct_size(std::size_t elements);

}  // namespace tyndall::radiosity
