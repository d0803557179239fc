// Fewer, larger polygons for the same surface: coplanar triangles merged into convex polygons.
//
// Method: connected coplanar triangles are cut along the lines of their common outline's edges, the
//   line that resolves most reflex corners first, until no outline edge has surface on both sides
//   of its line; what is left in each cell is then convex and is its own convex hull. Vertices
//   inside the surface (Steiner points) vanish.
// Valid for: triangles that meet in whole edges. Where the cuts would make more polygons than there
//   were triangles, the triangles are kept.
// Cost: O(outline edges × triangles) a cell.
// Source: binary space partitions of planar regions: de Berg et al., Computational Geometry,
// ch. 12.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mesh/types.h"

namespace tyndall::mesh {

// A planar convex polygon, counter-clockwise seen from the side its normal looks to.
struct ConvexPolygon {
    std::vector<Point> corners;  // [m]
    Direction normal{0};
};

enum class Facing {
    kept,     // triangles merge only with those that look to the same side
    ignored,  // either side will do (occluders)
};

// `tolerance`: distance [m] within which points count as on a plane or a line.
std::vector<ConvexPolygon> convex_merge(std::span<const Point> points,
                                        std::span<const std::array<VertexId, 3>> triangles,
                                        Facing facing, double tolerance);

}  // namespace tyndall::mesh
