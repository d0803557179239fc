// How far a solution is from another: the part of `tyndall compare` that knows no pictures.
#pragma once

#include <optional>

#include "cli/solution_points.h"

namespace tyndall::cli {

// Errors of J in the media and of E on the sides; none where the scene has no such place.
// Probed: what `tyndall probe` says, direct light in closed form and the rest gathered: how good
//   the solution is as a set of sources. Held: what the leaves hold, against what the reference
//   says there by probe: how good the mesh is.
struct SolutionErrors {
    std::optional<PointErrors> source, irradiance;
    std::optional<PointErrors> source_held, irradiance_held;
};

struct SolutionComparison {
    std::size_t points = 256;  // in the media, and as many on the sides
    std::size_t rays = 1024;   // a probe
};

// Purpose: errors at quasi-random points of the reference's scene (sample_points), so that places
//   count by their capacity, 4 kappa_t volume or area.
// Errors: mesh::InputError: other bands; a point that lies in no space of the solution.
// Cost: 4 `points` probes.
SolutionErrors compare_solutions(const radiosity::Solution& solution,
                                 const radiosity::Solution& reference,
                                 const SolutionComparison& options,
                                 const radiosity::ProgressCallback& progress = {});

}  // namespace tyndall::cli
