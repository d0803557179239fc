// The one primitive: a ray through the base tetrahedra, tet by tet, to the facet it ends on.
//
// Method: vertices are projected along the ray; the ray leaves a tet by the face whose projection
// holds
//   the ray's point. The three edge tests are 2-D cross products of shared vertices, antisymmetric
//   to the last bit and with ties broken by vertex index, so two tets never disagree about a shared
//   edge: a ray through an edge or a vertex, or along a face, still has one next tet. Distances are
//   interpolated between the face's vertices, hence bounded even where the face is seen edge-on.
// Cost: one projection, three cross products and a division a tet.
// Source: Platis & Theoharis (2003), Garrity (1990); tie rule after Edelsbrunner & Mücke (1990).
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "mesh/base_mesh.h"

namespace tyndall::mesh {

struct Ray {
    Point origin;                                             // [m]
    Direction direction;                                      // unit
    double length = std::numeric_limits<double>::infinity();  // where the walk ends [m]
};

enum class Arrival {
    struck,   // an opaque facet
    left,     // the hull
    ended,    // the ray's length
    stopped,  // by the visitor
    lost,     // the step cap was hit: a bug, counted and reported
};

struct WalkEnd {
    Arrival arrival = Arrival::lost;
    FacetId facet;            // struck; none on the hull if no facet lies there
    Side side = Side::front;  // of the facet, that the ray came from
    TetId tet;                // the last tet
    double distance = 0.0;    // along the ray [m]
};

namespace walk_detail {

// The projection of a vertex: (u, v) across the ray, w along it.
struct Projected {
    double u, v, w;
    std::uint32_t id;
};

struct Frame {
    Point origin;
    Direction u, v, w;

    explicit Frame(const Ray& ray) : origin(ray.origin), w(ray.direction) {
        // Branch on the smallest component keeps u well away from zero length.
        const Direction axis = std::abs(w.x) < 0.6 ? Direction(1, 0, 0) : Direction(0, 1, 0);
        u = glm::normalize(glm::cross(axis, w));
        v = glm::cross(w, u);
    }
    Projected operator()(const BaseMesh& mesh, VertexId id) const {
        const auto p = mesh.points[id.value] - origin;
        return {glm::dot(p, u), glm::dot(p, v), glm::dot(p, w), id.value};
    }
};

// Twice the signed area of (ray point, a, b) in projection. cross(a, b) == −cross(b, a) exactly.
inline double cross(const Projected& a, const Projected& b) {
    return a.u * b.v - a.v * b.u;
}

// Whether cross(a, b) counts as positive; a tie goes by index, so positive(a,b) != positive(b,a)
// always.
inline bool positive(double cross_ab, const Projected& a, const Projected& b) {
    return cross_ab > 0.0 || (cross_ab == 0.0 && a.id < b.id);
}

}  // namespace walk_detail

// The three corners of the face opposite corner k, counter-clockwise seen from outside the tet.
inline constexpr std::array<std::array<int, 3>, 4> face_corners{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

// Where a ray starts: in a tet, or on one of its faces (the face opposite corner `face`).
struct WalkStart {
    TetId tet;
    int face = inside;
    static constexpr int inside = 4;
};

// The start of rays that leave a facet on the given side.
inline WalkStart start_on(const BaseMesh& mesh, FacetId facet, Side side) {
    const TetId tet = mesh.facets[facet.value].tets[side == Side::front ? 0 : 1];
    const auto& faces = mesh.tet_facets[tet.value];
    const auto face = std::find(faces.begin(), faces.end(), facet) - faces.begin();
    return {tet, static_cast<int>(face)};
}

// Which facets end a walk.
enum class Passes { interfaces, everything };

// Walks from `start` to an opaque facet, the hull, or the ray's length.
// on_tet(TetId, double t_in, double t_out) → bool: false stops the walk. Interfaces are passed
// (everything is passed, but for the hull, if so asked).
// t_in of the first tet is 0; t_out of each is t_in of the next; zero lengths are not reported.
template <Passes passes = Passes::interfaces, class OnTet>
WalkEnd walk(const BaseMesh& mesh, const Ray& ray, WalkStart start, OnTet&& on_tet);

}  // namespace tyndall::mesh

#include "mesh/walk_impl.h"
