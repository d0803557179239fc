#include "cli/compare_solutions.h"

#include <fmt/format.h>

#include "mesh/input_error.h"

namespace tyndall::cli {

SolutionErrors compare_solutions(const radiosity::Solution& solution,
                                 const radiosity::Solution& reference,
                                 const SolutionComparison& options,
                                 const radiosity::ProgressCallback& progress) {
    if (solution.enclosure->bands != reference.enclosure->bands)
        throw mesh::InputError(
            fmt::format("the solution has {} bands and the reference {}. Solve both with the same.",
                        solution.enclosure->bands, reference.enclosure->bands));
    const auto points = sample_points(*reference.enclosure, options.points);
    const auto right = probed_values(reference, points, options.rays, progress);
    const auto probed = probed_values(solution, points, options.rays, progress);
    const auto held = held_values(solution, points);
    SolutionErrors errors;
    errors.source = point_errors(points, PointKind::in_space, probed, right);
    errors.irradiance = point_errors(points, PointKind::on_sides, probed, right);
    errors.source_held = point_errors(points, PointKind::in_space, held, right);
    errors.irradiance_held = point_errors(points, PointKind::on_sides, held, right);
    return errors;
}

}  // namespace tyndall::cli
