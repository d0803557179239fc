// How a long computation tells where it is, and is asked to stop.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace tyndall::radiosity {

struct Progress {
    std::string stage;         // "exchange areas", "direct light", …
    double fraction = 0.0;     // of the stage, 0 to 1
    std::size_t elements = 0;  // of the mesh so far
    double residual = 0.0;     // of the solver, where there is one
};

// Returns false to ask for a stop: the computation ends as soon as it has a valid result.
using ProgressCallback = std::function<bool(const Progress&)>;

}  // namespace tyndall::radiosity
