// What two polygons exchange through a medium, to a requested tolerance.
#pragma once

#include <optional>
#include <span>

#include "mesh/visible_polygon.h"
#include "radiosity/adaptive_cubature.h"
#include "radiosity/optical_depth.h"

namespace tyndall::radiosity {

// K(u) of the optical depth u between two points. What a zone exchanges is a sum over its faces of
// differences of transmittance: first differences with a patch, second ones with another zone. What
// cancels in them anyway is left out: thin zones lose no digits.
enum class DepthKernel {
    transmittance,  // e^{−u}: patch to patch
    first,          // e^{−u} − 1: patch to zone
    second,         // e^{−u} − 1 + u: zone to zone
};

double kernel_value(DepthKernel kernel, double depth);

// Between polygons that face each other: q lies in front of p's plane, p in front of q's.
struct PolygonPair {
    std::span<const Point> p, q;   // convex [m]
    Direction p_normal, q_normal;  // unit, either sign
};

// ∫∫ K |cosθ_p cosθ_q| / (π s²) dA_p dA_q [m^2], every point of p seeing every point of q, one
// extinction κ between them [1/m].
// Method: over q in closed form (Lambert) where K = 1; else in polar coordinates about the foot of
//   the point on q's plane, by sectors below q's edges, with the radius and the place along the
//   edge as hyperbolic sines of the variables: both integrals are then smooth on the scale of 1
//   however near the point is. Over p by adaptive cubature.
// Errors: none; Integral::reached says whether `options` was met.
// Cost: some 1e4 to 1e6 points of q.
Integral exchange_in_sight(const PolygonPair& pair, double extinction, DepthKernel kernel,
                           const CubatureOptions& options);

// The same where occluders may be in the way or media differ: q is cut to its visible part at
// every point of p.
// Cost: some 1e5 to 1e7 points: visibility has kinks that the cubature has to find.
struct Obstacles {
    const Enclosure& enclosure;
    const mesh::Occluders& occluders;
    const OpticalDepth& depth;
    std::size_t band = 0;
    // Between p and q [1/m]; none where media that differ lie there: `depth` tells.
    std::optional<double> extinction;
};
Integral exchange_past(const PolygonPair& pair, const Obstacles& obstacles, DepthKernel kernel,
                       const CubatureOptions& options);

// ∫ K |cosθ_p cosθ_q| / s² dA_q [sr] from one point, q relative to it, in front of it; p_normal 0:
// without cosθ_p.
double exchange_from_point(std::span<const Point> q, Direction q_normal, Direction p_normal,
                           double extinction, DepthKernel kernel);

}  // namespace tyndall::radiosity
