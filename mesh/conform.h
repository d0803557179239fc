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
// Output: every facet with the polygons it lies on, turned the way the first of them looks. Sides:
//   the first opaque polygon owns both sides of its facets; where polygons coincide, a later opaque
//   one takes the side its front looks to; interfaces own none.
// Method: points within the tolerance are one (the first to come); pieces within the tolerance of a
//   larger one's plane lie in it; points are moved onto the planes they touch; points near edges
//   and crossings split edges; each plane is triangulated with exact predicates and constructions,
//   and the rounded result checked exactly. Where facets still cross, the facets are conformed
//   again with four times the tolerance, at most four times. A polygon that is flat within 1e-5 of
//   its extent but not within the tolerance becomes triangles.
// Errors: InputError naming the polygon (fewer than three corners, not finite, not planar, zero
//   area, self-intersecting), or the two that cannot be cut apart.
// Cost: O(n log n + contacts); a plane with n points and s segments O(n s) at worst.
// Source: per plane, Constrained_triangulation_plus_2 of CGAL; tolerance by snapping after
//   Milenkovic (1988), "Verifiable implementations of geometric algorithms using finite precision
//   arithmetic".
ConformingComplex conform(std::span<const Polygon> polygons, const ConformOptions& options = {});

}  // namespace tyndall::mesh
