// Where light is gathered.
#pragma once

#include "mesh/walk.h"

namespace tyndall::radiosity {

using mesh::Direction;
using mesh::Point;

// In a zone (no normal), or on the side of a surface that `normal` looks from.
struct GatherPoint {
    Point x{0.0};
    mesh::WalkStart start;
    Direction normal{0.0};  // unit; zero in a zone

    bool on_surface() const { return normal != Direction(0.0); }
};

}  // namespace tyndall::radiosity
