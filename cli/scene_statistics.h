// What a scene is made of, once it is meshed, and what its solution will need.
#pragma once

#include <string>
#include <vector>

#include "cli/job.h"

namespace tyndall::cli {

struct Measured {
    std::string name;
    double size = 0.0;  // area [m^2] or volume [m^3]
};

struct SceneStatistics {
    std::size_t polygons = 0, triangles = 0, tetrahedra = 0, bands = 1;
    mesh::Point hull_min{0}, hull_max{0};  // [m]
    std::vector<Measured> sides, openings, media;
    std::vector<Measured> solids;  // by the surfaces around them
    double empty_volume = 0.0;     // [m^3]
    bool open = false;
    double hull_area = 0.0;  // through which light leaves [m^2]
    std::vector<std::string> lights, cameras;
    // Of the process; foreseen from element counts and rays [byte].
    double memory_start = 0.0, memory_most = 0.0;
    std::vector<std::string> warnings;
};

SceneStatistics statistics_of(const SceneFile& file, const radiosity::Enclosure& enclosure);

}  // namespace tyndall::cli
