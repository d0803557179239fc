// Light from lit patches at the elements of a solve.
#pragma once

#include "radiosity/elements.h"
#include "radiosity/lit_patches.h"

namespace tyndall::radiosity {

// H from lit patches, the mean over each element by a rule of degree 2 ([element * bands + band])
// [W/m^2/sr]. Cost: three or four gathers a member of an element.
std::vector<double> incident_lit(const Enclosure& enclosure, const Forest& forest,
                                 const Elements& elements, const LitPatches& lit);

}  // namespace tyndall::radiosity
