// The room between two convex polygons: all segments from one to the other.
#pragma once

#include <span>
#include <vector>

#include "mesh/visible_polygon.h"

namespace tyndall::mesh {

// The convex hull of two planar convex polygons, as half spaces. What lies wholly outside of it
// comes between no two of their points; a polygon that has a part inside does.
// Cost: O(corners³) to make, O(planes) a polygon.
// Source: Haines & Wallace (1991), shaft culling.
class Shaft {
  public:
    // `tolerance` [m]: how deep inside something has to be.
    Shaft(std::span<const Point> p, std::span<const Point> q, double tolerance);

    // Whether some segment from one to the other meets the polygon, ends and rims left out.
    bool meets(std::span<const Point> polygon) const;

  private:
    void add(Point a, Point b, Point c, std::span<const Point> p, std::span<const Point> q,
             double tolerance);

    std::vector<HalfSpace> planes_;  // normal·x ≥ offset is inside by more than the tolerance
};

}  // namespace tyndall::mesh
