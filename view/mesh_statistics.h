// What the elements of a solution's mesh are like, one number an element.
#pragma once

#include <vector>

#include "radiosity/solution.h"

namespace tyndall::view {

// Of the leaves that light can reach: patches, and zones of media.
struct MeshStatistics {
    std::vector<double> patch_area, zone_volume;                // [m^2], [m^3]
    std::vector<double> patch_radius_ratio, zone_radius_ratio;  // shape_quality.h [-]
    std::vector<double> patch_mean_ratio, zone_mean_ratio;      // likewise [-]
    std::vector<double> patch_level, zone_level;                // bisections since the base mesh
    std::vector<double> patch_error, zone_error;  // estimated, of what it sends out [W/m^2/sr]
    // V^{1/3} times the extinction of the band where that is largest [-].
    std::vector<double> zone_thickness;
};

// Cost: linear in the leaves.
MeshStatistics mesh_statistics(const radiosity::Solution& solution);

// Of numbers that are such; all 0 where there are none. `median` is the lower one of two.
struct Spread {
    std::size_t count = 0;
    double least = 0.0, median = 0.0, mean = 0.0, most = 0.0;
};
Spread spread_of(std::vector<double> values);

}  // namespace tyndall::view
