// Elements as polygons: what pairwise methods integrate over.
#pragma once

#include "mesh/convex_merge.h"
#include "radiosity/exchange.h"

namespace tyndall::radiosity {

// A flat convex piece of a patch, or of a zone's boundary.
struct ElementFace {
    mesh::ConvexPolygon polygon;  // normal: off the surface; out of the zone
    bool open = false;            // light passes, both ways: a zone's that is no wall
    TetId front, back;  // beside it, where the normal looks to and behind; none: nothing is there
};

// All faces of an element; of elements.outside() those of the hull that light can reach, which look
// inwards. A cluster's are merged over its members.
// Cost: O(members log members).
std::vector<ElementFace> faces_of(const Discretization& d, ElementId element);

// Opaque facets that light can reach from either side, merged whichever way they look; `tolerance`
// as convex_merge has it [m].
std::vector<mesh::ConvexPolygon> occluding_polygons(const Enclosure& enclosure, double tolerance);
// Facets that light passes between media that differ in any band.
std::vector<mesh::ConvexPolygon> media_interfaces(const Enclosure& enclosure);

// Points nearer than this to a plane lie on it [m].
double plane_tolerance(const Enclosure& enclosure);

}  // namespace tyndall::radiosity
