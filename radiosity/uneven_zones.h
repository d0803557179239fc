// Zones whose leaves no function that is linear over the whole zone can stand for.
#pragma once

#include <vector>

#include "radiosity/fields.h"

namespace tyndall::radiosity {

// Purpose: where a gather must see leaves, however far away: light that is spread over a zone in
//   place of where it is goes past what hides it, and another way past its receiver.
// Inner zones in which the leaves' J departs from the zone's by so much, δJ, that across it
//     κ h δJ > J̄                                                                            (70)
//   in any band: h its longest edge, J̄ the mean over its region.
// `sources`: J of all zones, coarsened [W/m^2/sr]. Cost: O(zones).
std::vector<ZoneId> uneven_zones(const Enclosure& enclosure, const Forest& forest,
                                 const Fields& sources);

}  // namespace tyndall::radiosity
