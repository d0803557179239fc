// How regular elements are.
#pragma once

#include <array>

#include "mesh/types.h"

namespace tyndall::view {

// Purpose: 1 for equal edges l, 0 for no volume V or area A.
// Equation: 12 (3 V)^(2/3) / sum l², 4 sqrt(3) A / sum l².
// Source: Liu & Joe (1994), Relationship between tetrahedron shape measures (mean ratio).
double mean_ratio(const std::array<mesh::Point, 4>& corners);
double mean_ratio(const std::array<mesh::Point, 3>& corners);

// Purpose: radius of the inscribed sphere or circle over that of the circumscribed one, times 3 or
//   2: 1 for equal edges, 0 for no volume or area.
// Equation: 216 V² / (A sqrt((a+b+c)(a+b−c)(a+c−b)(b+c−a))), A the area of all faces, a, b, c the
//   products of the lengths of opposite edges; (b+c−a)(c+a−b)(a+b−c) / (a b c).
// Source: Liu & Joe (1994), likewise (radius ratio).
double radius_ratio(const std::array<mesh::Point, 4>& corners);
double radius_ratio(const std::array<mesh::Point, 3>& corners);

}  // namespace tyndall::view
