// Which surfaces of a scene the tetrahedra of a file follow.
#pragma once

#include <map>
#include <span>
#include <unordered_map>

#include "mesh/base_mesh.h"
#include "mesh/conform.h"
#include "mesh/facet_groups.h"
#include "mesh/tet_file.h"

namespace tyndall::mesh {

// The facets near a point, by a uniform grid over their bounding boxes.
// Cost: O(facets in the cell) a question.
class FacetFinder {
  public:
    FacetFinder(const ConformingComplex& complex, double tolerance);

    // Facets within the tolerance of x, ascending.
    std::vector<FacetId> at(Point x) const;

  private:
    std::size_t cell(const glm::ivec3& c) const {
        return static_cast<std::size_t>((c.z * cells_ + c.y) * cells_ + c.x);
    }
    glm::ivec3 cell_of(Point x) const;

    const ConformingComplex& complex_;
    double tolerance_;
    Point low_{0}, step_{1};
    int cells_ = 1;
    std::vector<std::vector<FacetId>> lists_;
};

// Sheets: coplanar facets on the same surfaces, joined across edges that no other facet shares. The
// polygons and triangles that make up a sheet need not be followed, its outline must be. Polygons
// are of one surface if they have the same name (and opacity), or are the same polygon.
FacetGroups sheets_of(const ConformingComplex& complex, std::span<const Polygon> polygons);

// A face between two tets, or of one: its corners counter-clockwise seen from inside `tet`.
struct TetFace {
    std::array<std::uint32_t, 3> corners;
    std::uint32_t tet;
    bool boundary = false;  // no tet on its other side
};

// Nodes on the scene's surfaces, moved onto them. Edges and corners go first: a node near an edge
// of a facet comes to lie on that edge, one near a corner on the corner.
struct FittedNodes {
    std::vector<Point> points;                                   // of the file's nodes, moved [m]
    std::vector<std::vector<FacetId>> facets;                    // that each lies on
    std::vector<std::uint32_t> same;                             // node that stands for this one
    std::unordered_map<std::uint32_t, std::uint32_t> at_corner;  // point of the complex → node
    // Nodes inside an edge of the complex (its points ascending), in no order.
    std::map<std::array<std::uint32_t, 2>, std::vector<std::uint32_t>> on_edge;
};

FittedNodes fit_nodes(const TetFile& file, const ConformingComplex& complex,
                      const FacetFinder& finder, double tolerance);

// All faces once. Throws InputError where three tets share a face or two lie on one side of it.
std::vector<TetFace> faces_of(const TetFile& file, std::span<const Point> points);

struct SurfaceFace {
    std::array<std::uint32_t, 3> corners;
    FacetId source;  // that its centroid lies on
};

struct Matched {
    std::vector<SurfaceFace> faces;  // those that lie on facets
    std::vector<FacetId> outside;    // facets of sheets that no face lies on
};

// Throws InputError: a sheet that the faces cover in part, or that runs through tets unfollowed.
Matched match_surfaces(const TetFile& file, const ConformingComplex& complex,
                       std::span<const Polygon> polygons, const FacetGroups& sheets,
                       const FacetFinder& finder, const FittedNodes& nodes,
                       std::span<const TetFace> faces);

}  // namespace tyndall::mesh
