// How a long computation says where it is, and is told to stop.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace tyndall::radiosity {

// Where a computation is. Zero elements or residual: not known in this stage, not shown.
struct Progress {
    std::string stage;         // "mesh", "pass 3: rows", "render", …
    double fraction = 0.0;     // of this stage that is done, 0 to 1 [-]
    std::size_t elements = 0;  // patches and zones
    double residual = 0.0;     // relative residual of the linear system [-]
};

// Returns false to ask for a stop: the computation then ends soon, with what it has in a valid
// state. An empty callback means nobody listens. Whoever calls it does so from one thread at a
// time.
using ProgressCallback = std::function<bool(const Progress&)>;

// Tells a callback, if there is one. Returns false if it asks for a stop.
inline bool report(const ProgressCallback& callback, const Progress& progress) {
    return !callback || callback(progress);
}

}  // namespace tyndall::radiosity
