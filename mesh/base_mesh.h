// The coarse tetrahedral mesh: watertight topology for the walk. Flat arrays, index = identity.
#pragma once

#include <array>
#include <vector>

#include "mesh/polygon.h"
#include "mesh/types.h"

namespace tyndall::mesh {

// A triangle on which a surface, an opening or the hull lies; it separates two tets.
struct BaseFacet {
    std::array<VertexId, 3> corners;  // counter-clockwise seen from its front
    FacetId source;                   // facet of the conforming complex its centroid lies on
    Opacity opacity = Opacity::opaque;
    std::array<TetId, 2> tets;  // on its front and on its back side; none beyond the hull

    bool operator==(const BaseFacet&) const = default;
};

// Facets that stand in the tets without being cut into them: no tet has them on a face, and a walk
// ends where it meets them (body.h).
struct Body {
    // A sphere about some of its triangles; a tree of them, in depth-first order.
    struct Bound {
        Point centre{0};  // [m]
        double radius = 0.0;
        std::uint32_t next = 0;               // the bound after all that are within this one
        std::uint32_t triangle = 0, end = 0;  // of `triangles`; the same: it holds bounds

        bool operator==(const Bound&) const = default;
    };

    FacetId first, end;  // of its facets
    Point centre{0};     // of a sphere that holds it [m]
    double radius = 0.0;
    bool closed = false;  // its fronts look outward all round: nothing is inside
    double gap = 0.0;     // rays do not see it before this distance from their origin [m]
    std::vector<Bound> bounds{};
    std::vector<FacetId> triangles{};  // in the order of the bounds

    bool operator==(const Body&) const = default;
};

struct BaseMesh {
    std::vector<Point> points;                  // [m]
    std::vector<std::array<VertexId, 4>> tets;  // positively oriented: (b−a)×(c−a)·(d−a) > 0
    // Across the face opposite corner k; none at the hull.
    std::vector<std::array<TetId, 4>> neighbours;
    // The facet on the face opposite corner k; none if free.
    std::vector<std::array<FacetId, 4>> tet_facets;
    std::vector<BaseFacet> facets;
    std::vector<RegionId> regions;  // of each tet: tets connected without crossing any facet
    std::size_t region_count = 0;
    Point hull_min{0}, hull_max{0};  // the box that the mesh fills [m]
    std::vector<Body> bodies;        // their facets come last

    // The same to the last bit: a forest of one is a forest of the other.
    bool operator==(const BaseMesh&) const = default;
};

// Fills regions and region_count: flood fill from tet to tet where no facet lies between.
void find_regions(BaseMesh& mesh);

// The tet that holds x, by walking from `start` and, should that fail, by search; none outside the
// hull. Cost: O(tets^(1/3)), worst O(tets).
TetId locate(const BaseMesh& mesh, Point x, TetId start = TetId(0));

// Volume of a tet [m^3].
double volume(const BaseMesh& mesh, TetId tet);

// Area [m^2] and unit normal (towards the front) of a facet.
double area(const BaseMesh& mesh, FacetId facet);
Direction normal(const BaseMesh& mesh, FacetId facet);

// Of the box around the hull [m].
double diagonal(const BaseMesh& mesh);

// 1 − cosine of the angle below which two facets count as one plane [-].
inline constexpr double coplanar = 1e-9;

}  // namespace tyndall::mesh
