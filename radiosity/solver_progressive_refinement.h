// Progressive refinement: shooting instead of gathering.
#pragma once

#include "radiosity/solver.h"

namespace tyndall::radiosity {

// Purpose: the linear system by shots. Every element holds what it has received, and of what that
//   makes it send the part Δ that it has not sent yet. The one with the most unshot power, π c Δ,
//   shoots: every element receives its share, over the column of the shooter,
//     H_j ← H_j + S_ji δ / c_j,   Δ_j ← Δ_j + a_j S_ji δ / c_j,   Δ_i ← Δ_i − δ.           (39)
//   Patches and zones shoot alike. At first Δ is the source: lamps shoot first, then what they
//   light most, and every state on the way is a picture of the scene. A zone also receives from
//   itself: δ = Δ_i / (1 − a_i S_ii/c_i) sums that up at once.
// Columns: of the rows that are kept: the same linear system as of the other solvers. With
//   problem.rows the row of the shooter is made when it shoots and, by reciprocity, used as its
//   column: no matrix is kept. Such shots lose no power, whatever the rays; but S_ji is then what
//   row i says, and the solution differs by as much as rows are not reciprocal. Elements shoot
//   constants there.
// Overshooting (options.overshooting): δ = Δ_i + a_i H, H the ambient estimate (36): what the
// shooter
//   is going to receive and reflect is shot along with what it has; what it does not come to is
//   taken back by a negative shot.
// Ambient: with options.ambient, and ended before its tolerance, a H is added to x.
// Valid for: every a ≤ 1 with some loss, open and closed. Ends where whatever is shot only goes
// round.
//   It is Southwell's relaxation (Gortler, Cohen & Slusallek 1994): for entries ≥ 0 the unshot
//   power falls with every shot, in whatever order. Rows with moments have entries below 0 in the
//   system; that it converges for them is measured, not proved.
//   The gradients that a shot changes in its neighbours, and the nodes above it, have columns of
//   their own, which go out when they have as much to send as an element has.
// Units: `iterations` of the result is shots / elements, rounded up.
// Errors: none; not converged is a result.
// Cost: a column a shot, by one thread; on the fly a row of rays, in parallel over the elements
// that
//   shoot next. To 1e-6 some tens of shots an element. Memory: the entries once more for columns;
//   on the fly O(elements).
// Source: Cohen, Chen, Wallace & Greenberg (1988); overshooting: Feda & Purgathofer (1992).
SolverResult solve_progressive_refinement(const LinearProblem& problem,
                                          const SolverOptions& options);

}  // namespace tyndall::radiosity
