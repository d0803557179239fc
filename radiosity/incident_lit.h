// Light from lit patches at the elements of a solve.
#pragma once

#include <span>
#include <vector>

#include "mesh/body.h"
#include "radiosity/elements.h"
#include "radiosity/lit_patches.h"

namespace tyndall::radiosity {

// H from lit patches as it was before bodies have moved, and those bodies, before and now.
struct LitBefore {
    std::span<const double> means, in_middles;  // of the two functions below
    std::span<const mesh::Body> bodies;
};

// H from lit patches, the mean over each element by a rule of degree 2 ([element * bands + band])
// [W/m^2/sr]. Cost: three or four gathers a member of an element.
std::vector<double> incident_lit(const Enclosure& enclosure, const Forest& forest,
                                 const Elements& elements, const LitPatches& lit);

// The same in the middle of each element. Cost: one gather a member.
std::vector<double> lit_in_middles(const Enclosure& enclosure, const Forest& forest,
                                   const Elements& elements, const LitPatches& lit);

// The means after bodies have moved: what has changed in the middle of an element has changed so
// all over it, but within half its own size of a body, where the mean is taken anew. Cost: little
// more than lit_in_middles.
std::vector<double> incident_lit(const Enclosure& enclosure, const Forest& forest,
                                 const Elements& elements, const LitPatches& lit,
                                 const LitBefore& before);

}  // namespace tyndall::radiosity
