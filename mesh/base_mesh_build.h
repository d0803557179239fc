// From TetGen's lists to a checked BaseMesh.
#pragma once

#include <stdexcept>
#include <string>

#include "mesh/base_mesh.h"
#include "mesh/conform.h"
#include "mesh/facet_groups.h"
#include "mesh/tetgen_process.h"

namespace tyndall::mesh::tetgen {

struct Hull {
    Point min, max;  // [m]
};

// The result is not a mesh of what was asked for; what() says why. Never leaves `tetrahedralize`.
class Fault : public std::runtime_error {
  public:
    explicit Fault(const std::string& what, FacetId where = {})
        : std::runtime_error(what), facet(where) {}

    FacetId facet;  // where, if one facet shows it
};

// Purpose: BaseMesh from TetGen's output, where the facets of group i have the marker i + 1. Tets
//   in Hilbert order of their centroids, points in order of first use.
// Checked: tets > 0, positive orientation, volume of the hull, area of every group, at most two
//   tets a face, one only on the hull.
// Errors: Fault. Cost: O(n log n).
BaseMesh build_base_mesh(const Output& output, const ConformingComplex& complex,
                         const FacetGroups& groups, const Hull& hull);

}  // namespace tyndall::mesh::tetgen
