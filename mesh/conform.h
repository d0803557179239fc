// Makes any polygon soup conform: facets that meet only in whole edges and vertices.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mesh/polygon.h"

namespace tyndall::mesh {

// Which polygon owns one side of a facet, and which of the polygon's own sides that is.
struct SideOwner {
    PolygonId polygon;        // none where only interfaces lie here
    Side side = Side::front;  // the side of the polygon that this side of the facet is
};

// A triangle of the conforming complex.
struct ConformingFacet {
    std::array<VertexId, 3> corners;    // counter-clockwise seen from its front
    std::vector<PolygonId> polygons;    // every input polygon it lies on, ascending
    Opacity opacity = Opacity::opaque;  // opaque if any of its polygons is
    SideOwner front, back;              // owners of the two sides (opaque facets)
};

struct ConformingComplex {
    std::vector<Point> points;  // [m]
    std::vector<ConformingFacet> facets;
};

struct ConformOptions {
    double tolerance = 1e-7;  // points nearer than tolerance × scene diagonal are one point, planes
                              // within it one plane [-]
};

// Purpose: cut the polygons along all their mutual intersections and triangulate them, so that
//   TetGen accepts the result: emitters lying in a ceiling's plane, boxes on floors, crossing
//   shelves, T-junctions, duplicates, near-coplanar planes.
// Output: every facet with the polygons it lies on. Sides: an opaque polygon owns both sides of its
//   facets; where polygons coincide, a later one takes the side its front looks to; interfaces own
//   none.
// Errors: InputError naming the polygon (fewer than three corners, not finite, not planar, zero
// area,
//   self-intersecting).
ConformingComplex conform(std::span<const Polygon> polygons, const ConformOptions& options = {});

}  // namespace tyndall::mesh
