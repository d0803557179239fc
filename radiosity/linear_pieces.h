// A quadratic solution for those who can show linear functions only.
#pragma once

#include "radiosity/solution.h"

namespace tyndall::radiosity {

// Whether any of its leaves' functions are quadratic.
inline bool is_quadratic(const Solution& solution) {
    return !solution.direct.zone_bend.empty() || !solution.indirect.patch_bend.empty();
}

// Purpose: the solution with its patches bisected until linear functions between their corners show
//   their quadratic ones; zones keep their linear part, which has their mean.
// `tolerance`: what is left in the middle of an edge, over the mean radiosity of the surfaces / π
//   [-].
// Method: the longest edge at its middle, twelve times at most. Errors: those of the leaf bisected.
// Cost: a copy; pieces ~ patches / tolerance, 4096 a patch at most.
Solution linear_pieces(const Solution& solution, double tolerance);

}  // namespace tyndall::radiosity
