// A quadratic solution for those who can show linear functions only.
#pragma once

#include "radiosity/solution.h"

namespace tyndall::radiosity {

// Purpose: the solution with its patches bisected until linear functions between their corners show
//   their quadratic ones; zones keep their linear part, which has their mean.
// `tolerance`: what is left in the middle of an edge, over the mean radiosity of the surfaces / π
//   [-].
// `levels`: how often a patch and its pieces are bisected at most; twice leaves as many as a linear
//   solution has to show the same light.
// Method: the longest edge at its middle. Errors: those of the leaf bisected.
// Cost: a copy; pieces ~ patches / tolerance, 2^levels a patch at most.
Solution linear_pieces(const Solution& solution, double tolerance = 0.004, int levels = 2);

}  // namespace tyndall::radiosity
