// Shape of a mesh's leaves.
#pragma once

#include "mesh/forest.h"
#include "radiosity/solution.h"

namespace tyndall::cli {

// Mean ratios (view/shape_quality.h).
struct ElementQuality {
    double tet_min = 1.0, tet_mean = 1.0;            // of zones [-]
    double triangle_min = 1.0, triangle_mean = 1.0;  // of patches [-]
};

// Of all leaves that light can reach; 1 where there is none of a kind.
ElementQuality element_quality(const radiosity::Solution& solution);

}  // namespace tyndall::cli
