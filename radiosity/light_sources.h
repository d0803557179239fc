// Lights without an element: what they send out, and their shape.
#pragma once

#include <vector>

#include "radiosity/scene.h"

namespace tyndall::radiosity {

// Share of a spot light's intensity sent in unit direction `omega` [-]: 1 inside its cone, smoothly
// (3t² − 2t³) down to 0 over the soft edge outside it.
double spot_share(const SpotLight& spot, Direction omega);

// ∫ of the share over all directions [sr]; the power of a spot light is its intensity times this.
double spot_solid_angle(const SpotLight& spot);

// The sun's disc as a regular polygon at infinity with the disc's solid angle: corners are
// directions to it, on the plane at distance 1 across the beam, counter-clockwise seen from the
// origin.
std::vector<Point> sun_disc(const Sun& sun);

}  // namespace tyndall::radiosity
