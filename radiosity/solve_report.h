// What a solve says about itself, beyond the passes: residuals, balances, warnings.
#pragma once

#include "radiosity/balance.h"
#include "radiosity/coarse_solution.h"
#include "radiosity/direct_light.h"

namespace tyndall::radiosity {

// How a refinement ended.
struct Ending {
    double refined_to = 0.0;  // the error that refinement saw at its end [-]
    std::optional<ErrorParts> picture_error;
    ErrorParts solution_error;
    Escaped escaped_direct;           // power of direct light that leaves the hull
    double direct_power_check = 0.0;  // before H^A was made to balance [-]
    bool for_picture = false;         // it refined for the picture, not for the solution
    bool stopped = false;             // by the caller
    bool limited = false;             // by max_elements or max_memory
    bool out_of_time = false;         // by max_time
};

// Everything of a Report but patches, zones and passes. `incident_direct`: H^A of the coarse
// elements, as it was solved with ([element * bands + band]). Cost: two passes over the rows.
Report solve_report(const Enclosure& enclosure, const CoarseSolution& coarse,
                    const std::vector<double>& incident_direct, const DirectLight& light,
                    const SolveOptions& options, const Ending& ending);

}  // namespace tyndall::radiosity
