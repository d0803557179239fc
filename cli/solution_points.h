// Points at which solutions are compared, and what solutions say there.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "radiosity/progress.h"
#include "radiosity/solution.h"

namespace tyndall::cli {

struct SolutionPoint {
    mesh::Point x{0.0};           // [m]
    mesh::Direction normal{0.0};  // of the side it lies on; 0: a point in space

    bool on_side() const { return normal != mesh::Direction(0.0); }
};

// Purpose: `count` quasi-random points in the media, by 4 kappa_t volume, then as many on the sides
//   that light can reach, by area. So a plain mean over them weighs places by their capacity.
// None of a kind that the scene lacks. Cost: O(tets + facets + count).
std::vector<SolutionPoint> sample_points(const radiosity::Enclosure& enclosure, std::size_t count,
                                         std::uint64_t seed = 1);

// J at points in space [W/m^2/sr], E at points on sides [W/m^2]; one value a band.
using PointValues = std::vector<radiosity::Spectrum>;

// Purpose: what a probe says at the points (radiosity/probe.h), with the same random numbers at the
//   same points in every solution.
// Errors: mesh::InputError for a point outside the scene or in a solid. Cost: `rays` walks a point.
PointValues probed_values(const radiosity::Solution& solution,
                          const std::vector<SolutionPoint>& points, std::size_t rays,
                          const radiosity::ProgressCallback& progress = {});

// Purpose: what the leaf that holds each point holds there, by its linear function. Empty spectra
//   where there is no leaf. Cost: one walk a point.
PointValues held_values(const radiosity::Solution& solution,
                        const std::vector<SolutionPoint>& points);

// Errors over the points of one kind and all bands, in units of the mean of |reference| there.
struct PointErrors {
    std::size_t points = 0;
    double mean = 0.0, reference_mean = 0.0;  // [W/m^2/sr] or [W/m^2]
    double rmse = 0.0, bias = 0.0;            // [-]
};

enum class PointKind { in_space, on_sides };

// Points without a value in one of the two are left out. None if no point is left.
std::optional<PointErrors> point_errors(const std::vector<SolutionPoint>& points, PointKind kind,
                                        const PointValues& values, const PointValues& reference);

}  // namespace tyndall::cli
