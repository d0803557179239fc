// What a job will take, foreseen from a trial of it.
#pragma once

#include <memory>

#include "cli/job.h"

namespace tyndall::cli {

struct Forecast {
    std::size_t start_elements = 0;  // of the coarse solution
    std::size_t elements = 0;        // patches and zones at the goal, or at a limit before it
    bool limited = false;            // max_elements, max_memory or max_time end it before its goal
    bool at_least = false;           // the trial itself came to no end in its time
    double solve_cpu_seconds = 0.0, picture_cpu_seconds = 0.0;
    double wall_seconds = 0.0;  // of both, on the threads in use, as busy as they are now
    double memory = 0.0;        // at its peak [byte]
    double trial_cpu_seconds = 0.0;
};

// Purpose: foresee elements, time and memory of `tyndall run`. Method:
//   1. rows of some of the elements that the solve begins with are made by the method asked for,
//      and timed: times all elements, those of the coarse solution, and their entries its memory
//   2. the solve itself, to four times the error and with a fraction of the rays (walked): elements
//      grow with the error that is left as error^-0.42, as in example scenes; the passes'
//      times with elements and rays
//   3. the picture of every fourth row and column: times what is left out
// Cost: a fifth of the job or so, ten CPU-seconds at most beside the picture's part.
// How good it is: docs/validation.md. Errors: those of the solve.
Forecast foresee(const SceneFile& file, std::shared_ptr<const radiosity::Enclosure> enclosure,
                 ProgressLine& progress);

}  // namespace tyndall::cli
