// What two polygons exchange in empty space, from their contours.
#pragma once

#include <span>

#include "mesh/types.h"

namespace tyndall::radiosity {

// ∫∫ cosθ_p cosθ_q / (π s²) dA_p dA_q = (1/2π) |∮∮ ln s dl_p·dl_q| [m^2] for planar polygons,
// convex or not, that lie wholly in front of each other, with nothing in the way; they may touch.
// Method: the inner integral over an edge in closed form; the outer one by double-exponential
//   quadrature between the places where an end of the other edge, or its line, is nearest: what is
//   not smooth lies at the ends.
// Error: about 1e-14 of the area of the smaller polygon.
// Cost: some hundred logarithms and arc tangents a pair of edges.
// Source: Sparrow & Cess (1970); Goral et al. (1984); Takahasi & Mori (1974) for the quadrature.
double contour_integral(std::span<const mesh::Point> p, std::span<const mesh::Point> q);

}  // namespace tyndall::radiosity
