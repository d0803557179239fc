// What a solve says about itself, beyond the passes: residuals, balances, warnings.
#pragma once

#include "radiosity/coarse_solution.h"
#include "radiosity/direct_light.h"

namespace tyndall::radiosity {

// How a refinement ended.
struct Ending {
    double refined_to = 0.0;  // the error that refinement saw at its end [-]
    std::optional<ErrorParts> picture_error;
    ErrorParts solution_error;
    bool for_picture = false;  // it refined for the picture, not for the solution
    bool stopped = false;      // by the caller
    bool limited = false;      // by max_elements or max_memory
    bool out_of_time = false;  // by max_time
};

// Everything of a Report but patches, zones and passes. `incident_direct`: H^A of the coarse
// elements
// ([element * bands + band]). Cost: two passes over the rows, 16384 rays for what escapes.
Report solve_report(const Enclosure& enclosure, const CoarseSolution& coarse,
                    const std::vector<double>& incident_direct, const DirectLight& light,
                    const SolveOptions& options, const Ending& ending);

}  // namespace tyndall::radiosity
