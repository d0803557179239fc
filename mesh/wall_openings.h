// Openings in walls: planar interfaces that opaque facets stand around.
#pragma once

#include <vector>

#include "mesh/base_mesh.h"

namespace tyndall::mesh {

// Whether there are facets that light passes.
bool has_interfaces(const BaseMesh& mesh);

// Interfaces in groups, each of facets in one plane that have edges in common, and of its outline
// at least half along opaque facets: a hole in a wall, a door, the face of a fog bank from wall to
// wall; not the triangles of a curved interface. Cost: O(facets log facets).
std::vector<std::vector<FacetId>> wall_openings(const BaseMesh& mesh);

}  // namespace tyndall::mesh
