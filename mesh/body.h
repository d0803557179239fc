// Bodies in the tetrahedra: triangles that move from scene to scene while the tetrahedra stay.
//
// Purpose: a mesh that is made once holds bodies at any place, without a facet of theirs on a face
//   of a tet. Walks end on them: rows, gathers, probes and pictures are walks. Sides, patches and
//   occluders are those of any facet.
// Valid for: triangles of any number and place, each with two ends of every edge at the same
//   vertex: then no ray slips between neighbours, by the walk's own tests of edges.
// Cost: a test of a sphere a body and ray; of the rays that meet it, some tens of tests: a tree of
//   spheres leads to the triangles.
#pragma once

#include <span>

#include "mesh/walk.h"

namespace tyndall::mesh {

// Appends a body. `triangles`: indices into `points`, counter-clockwise seen from the front; their
// facets get the front tet that holds their centroid (none: outside the hull), and the same behind
// or, where the body is closed and turns its fronts outward, none. Facet `source` is none.
void add_body(BaseMesh& mesh, std::span<const Point> points,
              std::span<const std::array<std::uint32_t, 3>> triangles);

// The bodies' facets anew from the facets that are on no tet's face, `bodies` from their ends:
// what a file has kept.
Body body_of(const BaseMesh& mesh, FacetId first, FacetId end);

// Whether a facet is a body's.
bool on_body(const BaseMesh& mesh, FacetId facet);

// The body that holds x inside; none.
const Body* body_around(const BaseMesh& mesh, Point x);

// The point of a body's surface that is nearest to x, moved off it by 1e-5 of the body's size.
Point nearest_outside(const BaseMesh& mesh, const Body& body, Point x);

// The tet in front of a point on a facet side (2 f + side): the one that the mesh has there, or of
// a body's facet the one that holds the point.
TetId tet_before(const BaseMesh& mesh, std::uint32_t facet_side, Point x);

// The start of rays that leave a point of a facet on the given side.
WalkStart start_before(const BaseMesh& mesh, std::uint32_t facet_side, Point x);

}  // namespace tyndall::mesh
