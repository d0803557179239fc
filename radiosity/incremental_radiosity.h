// Scenes that change in emissions alone: each group of sources is shot once, and kept.
#pragma once

#include <span>

#include "radiosity/adaptive.h"
#include "radiosity/source_groups.h"

namespace tyndall::radiosity {

// What is kept between scenes: a solution of each group of sources alone, all on one mesh.
struct UnitShots {
    SourceGroups groups;
    std::vector<Solution> units;  // of each group; one dark solution where nothing gives light
    // Of each unit and band: the mean radiance of the view's picture; empty without a view
    // [W/m^2/sr].
    std::vector<Spectrum> picture;
    // Of each two units and band: Σ c x_k x_l over the leaves [m^2 (W/m^2/sr)^2].
    std::vector<std::vector<Spectrum>> products;
    std::size_t solves = 0;  // that were made, units and meshes
};

// Purpose: solutions from which those of all these scenes are sums:
//   1. a full adaptive solve with every source at its largest: the common mesh
//   2. each group alone on that mesh, frozen
//   3. where what leaves are too coarse for, `elements` of (47), is more than options.error in a
//      scene: that scene solved adaptively on from the common mesh, and 2 again; once
// `enclosure`: made of any of the scenes, or of groups.largest.
// Scenes: in emission alone different (compare_scenes.h). A stop that `progress` asks for leaves
//   valid solutions of what there is.
// Errors: those of solve_adaptively.
// Cost: a full solve, and about one more for each group where there is more than one. Memory: a
//   solution for each group.
// Source: Chen (1990), Incremental Radiosity, for surfaces: a changed emission is shot again, and
//   nothing else. Here whole shots of a unit are kept, for patches and zones alike.
UnitShots shoot_units(std::span<const Scene> scenes, const Enclosure& enclosure,
                      const SolveOptions& options, const std::optional<View>& view = {},
                      const ProgressCallback& progress = {});

// Purpose: the estimated errors of one of the scenes that were given to shoot_units, from those of
//   the units: with w_k the group's largest weight over bands, L_k the picture's mean radiance
//   and n_k² = Σ c x_k²,
//   elements² = Σ (w_k elements_k L_k)² / L²,  gathers, coarse = Σ w_k gathers_k L_k / L      (47)
//   of the picture, and with n for L of the solution: departures of leaves have either sign and are
//   independent from source to source; what sampling leaves is the same rays' for all.
ErrorParts superposed_picture_error(const UnitShots& shots, std::size_t scene);
ErrorParts superposed_solution_error(const UnitShots& shots, std::size_t scene);

// Purpose: the solution of one of the scenes that were given to shoot_units:
//   H = Σ_k w_k H_k,  x = Σ_k w_k x_k  in every band                                          (46)
//   of fields, coarse values and net power; the errors of leaves are Σ w_k times theirs.
//   Its report holds the largest balance, closure and residual of the units, and no passes.
// Cost: O(leaves × groups), and a copy of the base mesh and the forest.
Solution superposed(const UnitShots& shots, std::size_t index, const Scene& scene);

}  // namespace tyndall::radiosity
