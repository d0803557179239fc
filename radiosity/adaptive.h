// The main job: coarse solution → leaves split where they depart from it → radiances recomputed.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "radiosity/kept_light.h"
#include "radiosity/progress.h"
#include "radiosity/solution.h"
#include "radiosity/view.h"

namespace tyndall::radiosity {

// What of a solution refinement can begin with.
struct KeptMesh {
    mesh::BaseMesh base;
    Forest forest;
};

// Meshes of passes: kept, taken up again, frozen.
struct Passes {
    // Called with a valid solution after every pass that leaves a finer mesh than `begin_with`.
    std::function<void(const Solution&)> save{};
    // Called after every step that changes what would be seen, with the name of its pass and a
    // function that makes a valid solution of what there is: to watch it evolve. What the solve
    // returns is not shown again. The same bits with and without.
    std::function<void(const std::string& pass, const std::function<Solution()>&)> watch{};
    // The mesh of such a solution, to begin refinement with, after the same initial mesh.
    std::shared_ptr<const KeptMesh> begin_with{};
    bool frozen = false;  // nothing is bisected beyond it
    // What the solve has made is kept here, for scenes in which bodies have moved (kept_light.h).
    // The same bits with and without.
    std::shared_ptr<KeptLight> keep{};
    // What was kept before bodies have moved: the solve begins with it, its mesh and all, and makes
    // anew what has changed. fits(*moved, enclosure) must hold, and options be the same.
    std::shared_ptr<const KeptLight> moved{};
    // Rows of the elements that a solve begins with: taken from here where they are those that it
    // would make (shared_rows.h), which scenes have whose lights, albedo or reflectance alone
    // differ; else left here for the next. The same bits with and without.
    std::shared_ptr<SharedRows> rows{};
};

// Purpose: solve the enclosure to the error goal, as the literature has it (docs/theory.md):
//   1. initial mesh; rows of exchange areas; direct light; the coarse solution of the one equation
//   2. leaves bisected where direct light departs from linear, until the goal's share is met; the
//      coarse solution once more with the leaves' direct light summed into its elements
//   3. indirect light gathered from that solution at the elements' corners; bisected where it
//      departs from linear
//   4. every leaf's radiance recomputed from the coarse solution (Cohen et al. 1986; Rushmeier
//      1988)
// View: where errors matter, if given; everywhere else.
// A stop that `progress` asks for ends the loop at the next step; the solution is valid all the
//   same.
// Passes: the mesh of an interrupted run to go on from; a run gone on with has the same goal, not
//   the same bits.
// Moved: 1 and 4 by what is kept, corrected (48), (49); 2 where a body comes, or came, between a
//   place and a light; its report's rays are those that were walked.
// Errors: mesh::InputError for unknown methods, a mesh that cannot fit max_elements, a mesh to
// begin
//   with that is of another base mesh or of another initial mesh.
Solution solve_adaptively(std::shared_ptr<const Enclosure> enclosure, const SolveOptions& options,
                          const std::optional<View>& view = {},
                          const ProgressCallback& progress = {}, const Passes& passes = {});

}  // namespace tyndall::radiosity
