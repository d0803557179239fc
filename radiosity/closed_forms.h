// Light from a polygon of constant radiance, in closed form.
#pragma once

#include <span>

#include "mesh/types.h"

namespace tyndall::radiosity {

// Solid angle [sr] of a planar convex polygon, corners relative to the point it is seen from;
// positive whichever way round it runs, 0 seen edge-on.
// Equation: tan(Ω/2) = a·(b×c) / (abc + a(b·c) + b(c·a) + c(a·b)), summed over a fan of triangles.
// Cost: one arc tangent a triangle.
// Source: van Oosterom & Strackee (1983).
double solid_angle(std::span<const mesh::Point> corners);

// ∫ cosθ dω [sr] over a planar polygon, θ from the unit normal n; irradiance is radiance times
// this. Equation: ½ Σ Γ_k · n, Γ_k the angle that edge k subtends times the unit normal of its
// plane. Valid for: polygons wholly above the horizon of n (clip first: mesh::clip). Positive
//   whichever way round the polygon runs.
// Cost: one arc tangent an edge.
// Source: Lambert (1760); Baum, Rushmeier & Winget (1989), eq. 9.
double projected_solid_angle(std::span<const mesh::Point> corners, mesh::Direction n);

}  // namespace tyndall::radiosity
