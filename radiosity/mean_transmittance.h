// The mean of the transmittance over a polygon as a point sees it.
#pragma once

#include <span>
#include <vector>

#include <glm/geometric.hpp>

#include "radiosity/optical_depth.h"

namespace tyndall::radiosity {

// Who receives the light.
struct Receiver {
    Point x;              // [m]
    TetId tet;            // base tet that holds x
    Direction normal{0};  // of the surface; 0 in a medium
    bool on_surface = false;

    double cosine(Direction unit) const { return on_surface ? glm::dot(normal, unit) : 1.0; }
};

// Box that the mesh fills; beyond it there is no medium.
struct Hull {
    Point low{0}, high{0};

    // Distance from x, inside, to the box along a unit direction [m].
    double exit(Point x, Direction unit) const;
};

// Equation: τ̄ = ∫ τ w dA / ∫ w dA over the polygon, w = cosθ_emitter / s² (· cosθ on a surface):
//   the weights of the closed form it multiplies, so that a constant τ comes out exactly.
// Method: fan of triangles, bisected until τ's exponent varies by less than `step` over each;
//   three- or seven-point cubature (degrees 2 and 5).
// `corners` relative to x; of a polygon at infinity (`hull` given) directions on a plane at
// distance 1. `mean` has one value a band.
void mean_transmittance(const OpticalDepth& depth, const Receiver& receiver,
                        std::span<const Point> corners, const Hull* hull, double step,
                        std::span<double> mean);

}  // namespace tyndall::radiosity
