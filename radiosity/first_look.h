// What can be shown before anything is solved: surfaces in direct light, without the medium.
#pragma once

#include "radiosity/solution.h"

namespace tyndall::radiosity {

// Purpose: a solution for a first picture, at once: the enclosure with its media taken out, direct
//   light in closed form on its surfaces, and in place of all further light its ambient estimate,
//   the same everywhere:
//     H = Σ A ρ H^A / Σ A / (1 − ρ̄),  ρ̄ = Σ A ρ / Σ A.                                  (36)
//   The report says nothing.
// Valid for: a look. It leaves out openings as well: the estimate is that of a closed room.
// Cost: direct light at the corners of some 1500 patches.
// Source: Rushmeier (1991), section 4.2: surfaces are shown first; Cohen et al. (1988) for the
//   estimate.
Solution first_look(const Enclosure& enclosure, const SolveOptions& options);

}  // namespace tyndall::radiosity
