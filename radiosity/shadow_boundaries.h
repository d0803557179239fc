// Where the edges of shadows can be: planes behind the edges of what is opaque.
//
// Purpose: elements cut along these planes hold sharp light shafts with few elements.
// Method: a plane through an opaque edge that touches a light separates points that see it past
//   that edge from points that do not. A light of no extent has one such plane an edge, exactly: H
//   jumps there. A light with an extent has two, the extremal ones, which bound the penumbra: H
//   bends there. Only edges that are a silhouette from the light have one. A sheet is the part of
//   the plane behind the edge, between the rays through its two ends.
// Not valid for: planes through an emitter's edge and an occluder's corner (they round the corners
//   of penumbrae off), curved event surfaces, the rim of a spot light's cone. What other occluders
//   hide of a sheet is not cut off, but where they seal it off: whether light changes across it is
//   for the caller to find out.
// Cost: O(edges × lights + tets that sheets touch).
// Source: Nishita & Nakamae (1985); Campbell & Fussell (1990); Teller (1992).
#pragma once

#include <array>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "mesh/visible_polygon.h"
#include "radiosity/enclosure.h"
#include "radiosity/options.h"

namespace tyndall::radiosity {

struct ShadowPlane {
    Direction normal{0.0};  // unit
    double offset = 0.0;    // dot(normal, x) + offset is the distance of x [m]

    double at(Point x) const { return glm::dot(normal, x) + offset; }
};

struct ShadowSheet {
    ShadowPlane plane;
    std::uint32_t plane_index = 0;  // sheets on one plane share it
    std::array<mesh::HalfSpace, 3> bounds;
    std::array<mesh::VertexId, 2> edge;  // of the base mesh, behind which it lies
    // The sheet on the penumbra's other side; `none`: the shadow's edge is sharp.
    std::uint32_t partner = none;
};

// The part of a sheet that lies in an element, as a convex polygon; two points in a triangle.
struct ShadowSection {
    std::array<Point, 8> points;
    int count = 0;
    double share = 0.0;    // of the plane's whole section with the element, by its area or length
    bool crosses = false;  // the element has something on either side

    explicit operator bool() const { return count > 0; }
};

class ShadowBoundaries {
  public:
    // `emitters`: emitting surfaces count as lights.
    ShadowBoundaries(const Enclosure& enclosure, bool emitters);

    const std::vector<ShadowSheet>& sheets() const { return sheets_; }
    std::size_t plane_count() const { return planes_.size(); }
    const ShadowPlane& plane(std::uint32_t index) const { return planes_[index]; }
    // The sheets that touch a base tet and can be reached there from their edge without passing
    // anything opaque.
    std::span<const std::uint32_t> at(TetId tet) const {
        return {touching_.data() + begin_[tet.value], begin_[tet.value + 1] - begin_[tet.value]};
    }

    // Width of the penumbra at a point of a sheet; 0 if the edge is sharp [m].
    double width(const ShadowSheet& sheet, Point x) const;

    // How far a corner at x may be off a sheet's plane and still count as on it, in an element with
    // corners as far as `reach` from it [m]. A hundredth where the edge is sharp, less than a
    // penumbra is wide.
    double snap(const ShadowSheet& sheet, Point x, double reach) const;

    // Empty if sheet and element do not touch. `reach`: as `snap` takes it; 0: that of the element.
    ShadowSection section(const ShadowSheet& sheet, std::span<const Point> corners,
                          double reach = 0.0) const;

  private:
    struct Source;
    struct Edge;
    struct Fan;
    std::vector<Source> sources(const Enclosure& enclosure, bool emitters) const;
    ShadowSheet sheet_at(double angle, const Fan& fan, const Edge& edge,
                         const Source& source) const;
    void add_sheets(const Edge& edge, const Source& source);
    std::uint32_t index_of(ShadowPlane& plane);
    void spread(const mesh::BaseMesh& mesh);

    std::vector<ShadowSheet> sheets_;
    std::vector<ShadowPlane> planes_;
    std::multimap<double, std::uint32_t> plane_order_;  // by the distance of `origin_`
    Point origin_{0.0};
    double tolerance_;                // [m]
    std::vector<std::size_t> begin_;  // of each base tet in touching_
    std::vector<std::uint32_t> touching_;
};

// Those that elements are to be cut along by these options; none where they are not to be.
std::optional<ShadowBoundaries> shadow_boundaries(const Enclosure& enclosure,
                                                  const SolveOptions& options);

}  // namespace tyndall::radiosity
