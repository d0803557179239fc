// Transmittance and visibility of a polygon by shadow rays, where too many occluders overlap it.
#pragma once

#include <cstddef>
#include <span>

#include "radiosity/mean_transmittance.h"
#include "radiosity/occlusion.h"

namespace tyndall::radiosity {

// Equation: Σ w τ V / Σ w over points of the polygon, w as in mean_transmittance: what the whole
//   polygon's closed form is to be multiplied by.
// Method: `rays` points of the additive recurrence R2, shifted by a hash of the receiver's
//   position: deterministic, and unlike from point to point.
// Arguments as in mean_transmittance. Error falls as about rays^(−3/4).
// Source: Roberts (2018), R2; Cranley & Patterson (1976), shift.
void sampled_transmittance(const Occlusion& occlusion, const OpticalDepth& depth,
                           const Receiver& receiver, std::span<const Point> corners,
                           const Hull* hull, std::size_t rays, std::span<double> mean);

}  // namespace tyndall::radiosity
