// The main job: coarse solution → leaves split where they depart from it → radiances recomputed.
#pragma once

#include <memory>
#include <optional>

#include "radiosity/progress.h"
#include "radiosity/solution.h"

namespace tyndall::radiosity {

// Purpose: solve the enclosure to the error goal, as the literature has it (docs/theory.md):
//   1. initial mesh; rows of exchange areas; direct light; the coarse solution of the one equation
//   2. leaves bisected where direct light departs from linear, until the goal's share is met; the
//   coarse
//      solution once more with the leaves' direct light summed into its elements
//   3. indirect light gathered from that solution at the elements' corners; bisected where it
//   departs
//   4. every leaf's radiance recomputed from the coarse solution (Cohen et al. 1986; Rushmeier
//   1988)
// View: where errors matter, if given; everywhere else.
// A stop asked for by `progress` ends the loop at the next step; the solution is valid all the
// same. Errors: mesh::InputError for unknown methods, or a mesh that cannot fit max_elements.
Solution solve_adaptively(std::shared_ptr<const Enclosure> enclosure, const SolveOptions& options,
                          const std::optional<View>& view = {},
                          const ProgressCallback& progress = {});

}  // namespace tyndall::radiosity
