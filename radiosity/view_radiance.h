// How bright a view is, against which errors of its picture are measured.
#pragma once

#include "radiosity/gather.h"
#include "radiosity/view.h"

namespace tyndall::radiosity {

// The mean of what 32 × 24 rays of the view find, over bands [W/m^2/sr]. Cost: a walk a ray.
double mean_radiance(const GatherScene& scene, const Enclosure& enclosure, const View& view);

}  // namespace tyndall::radiosity
