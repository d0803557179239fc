// A sun of a finite angle as a disc that is far away, for programs without one.
#pragma once

#include "exports/path_room.h"

namespace tyndall::exports {

struct SunDisc {
    mesh::Point centre{0};  // [m]
    mesh::Direction up{0};  // across the light's direction
    double radius = 0.0;    // [m]
    Spectrum radiance;      // [W/m^2/sr]
};

// Purpose: a disc ten thousand rooms away, which looks at the room's centre: from one end of the
//   room to the other its direction changes by 1e-4 rad, and its irradiance by 2e-4.
// Equation: a disc of half angle α and radiance L has E = π L sin²α across the beam; its radius is
//   tan α of its distance.
SunDisc sun_disc(const radiosity::Sun& sun, mesh::Point centre, double size);

// A unit direction across the given one.
mesh::Direction across(mesh::Direction direction);

}  // namespace tyndall::exports
