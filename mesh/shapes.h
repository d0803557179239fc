// The shapes of the scene file, as lists of named faces.
#pragma once

#include <string>
#include <vector>

#include "mesh/polygon.h"

namespace tyndall::mesh {

// A face of a shape. `name` is the part behind the surface's name ("floor"; empty if the shape has
// one face).
struct Face {
    std::string name{};
    std::vector<Polygon> polygons{};
};

// A hole in a rectangle, `corner` and `size` in metres along its two axes.
struct Opening {
    std::string name{};
    double corner[2];  // [m]
    double size[2];    // [m]
};

// A hole in one face of a room or a box. Its two axes are the face's own, both increasing, from the
// face's lowest corner: (y, z) for x0 and x1, (x, z) for y0 and y1, (x, y) for floor, ceiling,
// bottom, top.
struct FaceOpening {
    std::string face{};  // "x0", …
    Opening opening;
};

// Each opening becomes a face of its own name, made of an interface, behind those of the shape.
// All three throw InputError if an opening leaves its face, is empty, overlaps another, or bears a
// name that is taken; room and box if min >= max or a face is unknown; rectangle if u or v is zero
// or they are not perpendicular (within 1e-6).

// Six faces whose fronts look inward: floor, ceiling, x0, x1, y0, y1.
std::vector<Face> room(Point min, Point max, const std::vector<FaceOpening>& openings = {});

// Six faces whose fronts look outward: bottom, top, x0, x1, y0, y1.
std::vector<Face> box(Point min, Point max, const std::vector<FaceOpening>& openings = {});

// The rectangle corner + s u + t v, 0 <= s,t <= 1; front = u × v.
std::vector<Face> rectangle(Point corner, glm::dvec3 u, glm::dvec3 v,
                            const std::vector<Opening>& openings = {});

// Throws InputError if a polygon has fewer than three corners, a corner that is not finite, corners
// off its plane by more than 1e-6 of its size, or no area. The message goes on behind the polygon's
// name: "has 2 corners. …".
void check_polygon(const Polygon& polygon);

}  // namespace tyndall::mesh
