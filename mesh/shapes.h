// The shapes of the scene file, as lists of named faces.
#pragma once

#include <string>
#include <vector>

#include "mesh/polygon.h"

namespace tyndall::mesh {

// A face of a shape. `name` is the part behind the surface's name ("floor"; empty if the shape has
// one face).
struct Face {
    std::string name;
    std::vector<Polygon> polygons;
};

// Six faces whose fronts look inward: floor, ceiling, x0, x1, y0, y1. Throws InputError if min >=
// max.
std::vector<Face> room(Point min, Point max);

// Six faces whose fronts look outward: bottom, top, x0, x1, y0, y1. Throws InputError if min >=
// max.
std::vector<Face> box(Point min, Point max);

// A hole in a rectangle, `corner` and `size` in metres along u and v.
struct Opening {
    std::string name;
    double corner[2];  // [m]
    double size[2];    // [m]
};

// The rectangle corner + s u + t v, 0 <= s,t <= 1; front = u × v. Each opening becomes a face of
// its own name made of an interface. Throws InputError if u, v are not perpendicular or an opening
// leaves the rectangle.
std::vector<Face> rectangle(Point corner, glm::dvec3 u, glm::dvec3 v,
                            const std::vector<Opening>& openings = {});

}  // namespace tyndall::mesh
