// Shape of a mesh's leaves.
#pragma once

#include "mesh/forest.h"
#include "radiosity/solution.h"

namespace tyndall::cli {

// Purpose: how regular a tetrahedron or triangle is: 1 for equal edges l, 0 for no volume V or area
//   A.
// Equation: 12 (3 V)^(2/3) / sum l², 4 sqrt(3) A / sum l².
// Source: Liu & Joe (1994), Relationship between tetrahedron shape measures (mean ratio).
double mean_ratio(const std::array<mesh::Point, 4>& corners);
double mean_ratio(const std::array<mesh::Point, 3>& corners);

struct ElementQuality {
    double tet_min = 1.0, tet_mean = 1.0;            // of zones [-]
    double triangle_min = 1.0, triangle_mean = 1.0;  // of patches [-]
};

// Of all leaves that light can reach; 1 where there is none of a kind.
ElementQuality element_quality(const radiosity::Solution& solution);

}  // namespace tyndall::cli
