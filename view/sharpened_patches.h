// Direct light on surfaces, fine enough to be looked at.
//
// A picture computes direct light on surfaces anew at every pixel, wherever the patches' linear
// functions would show (render/seen_solution.h); refinement relies on that and leaves such patches
// large. A page that is looked at cannot do so. Here those patches are bisected further, without a
// change to the solution, until linear functions show the same.
#pragma once

#include "radiosity/solution.h"

namespace tyndall::view {

struct SharpenOptions {
    double tolerance = 0.004;         // of a patch's radiance, over the surfaces' mean [-]
    std::size_t most_pieces = 30000;  // made
    double smallest_edge = 0.0005;    // of the hull's diagonal: no finer [-]
};

// The forest of the solution with more patches, and H^A of each [W/m^2/sr]; zones are the same.
struct SharpenedPatches {
    radiosity::Forest forest;
    radiosity::Fields direct;  // of patches
    std::size_t made = 0;      // bisections
    std::size_t left = 0;      // pieces that would be bisected, if more were allowed
};

// Purpose: direct light in closed form at the corners of bisected patches, the pieces with the
//   largest error times area first.
// Method: the longest edge at its middle, where the linear function of a piece departs from the
//   closed form at the middle of an edge.
// Cost: about six values of direct light a bisection. Same bits at any thread count.
SharpenedPatches sharpen_patches(const radiosity::Solution& solution,
                                 const SharpenOptions& options = {});

}  // namespace tyndall::view
