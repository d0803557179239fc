// The meshes of a solution's passes, told from its forest: which node was there when a pass ended,
// and what inner nodes hold.
//
// A solution file has the bisections in their order (mesh::Forest::history) and how many elements
// every pass left: that says in which pass each node was born. Files of earlier versions have both,
// too.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "radiosity/solution.h"

namespace tyndall::view {

// The mesh that a pass, or several after each other, ended with.
struct PassMesh {
    std::string passes;  // their names: "coarse solution, direct light"
    std::size_t patches = 0, zones = 0;
};

struct PassMeshes {
    // All different, from coarse to fine; the last is the solution's own. Passes whose numbers of
    // elements the forest never had are left out.
    std::vector<PassMesh> meshes;
    // Of each node: the first of these meshes that has it or what it was bisected into.
    std::vector<std::int32_t> zone_born, patch_born;
};

// Cost: linear in the nodes.
PassMeshes pass_meshes(const radiosity::Solution& solution);

// Purpose: a solution whose inner nodes hold what their leaves do: the mean, and the gradient that
//   means and gradients say, of direct and indirect light, as radiosity::coarsen makes them; means
//   of emission that was found. Leaves are as they were.
// Cost: linear in the nodes.
radiosity::Solution with_inner_nodes(const radiosity::Solution& solution);

}  // namespace tyndall::view
