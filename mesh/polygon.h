// Input geometry: planar polygons, each with a front side, tagged by their index.
#pragma once

#include <string>
#include <vector>

#include "mesh/types.h"

namespace tyndall::mesh {

enum class Opacity : std::uint8_t {
    opaque,     // light ends here
    interface,  // light passes: an opening, the face of a fog bank
};

// A planar simple polygon, convex or not. Its front is the side from which the corners run
// counter-clockwise (right-hand rule).
struct Polygon {
    std::vector<Point> corners{};  // at least three [m]
    Opacity opacity = Opacity::opaque;
    std::string name{};  // of the surface it belongs to; used in messages only
};

}  // namespace tyndall::mesh
