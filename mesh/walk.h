// The one primitive: a ray through the base tetrahedra, tet by tet, to the facet it ends on.
//
// Method: vertices are projected along the ray; the ray leaves a tet by the face whose projection
//   holds the ray's point. The edge tests are 2-D cross products of shared vertices whose signs are
//   exact, ties included: those are broken as if the vertices had been moved a little, each by an
//   amount of its own. So in every tet that is entered one face, and one only, is left by: also
//   where the ray meets an edge or a vertex, or runs along a face. A start on a tet's rim whose
//   projection misses the tet is moved into it by 1e-12 of its size or, if need be, more.
//   Distances are interpolated between the face's vertices, hence bounded even where the face is
//   seen edge-on.
// Cost: one projection, three cross products and a division a tet.
// Source: Platis & Theoharis (2003), Garrity (1990); Edelsbrunner & Mücke (1990) for ties.
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

// Where a ray meets a body first.
struct BodyHit {
    FacetId facet;  // none: it meets none
    Side side = Side::front;
    double distance = std::numeric_limits<double>::infinity();  // [m]
};

// Whether a ray comes near enough to a body, or to a bound of it, to meet it.
template <class Ball>
bool meets_sphere(const Ball& ball, const Ray& ray) {
    const auto to = ball.centre - ray.origin;
    const double along = glm::dot(to, ray.direction);
    const double beyond = glm::dot(to, to) - ball.radius * ball.radius;  // of the sphere, if > 0
    return beyond <= 0.0 ||
           (along > 0.0 && beyond <= along * along && along - ball.radius <= ray.length);
}

// The first facet of a body that a ray meets within its length (body.h).
BodyHit first_body(const BaseMesh& mesh, const Ray& ray);

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

// Whether cross(a, b) counts as positive; positive(a, b) != positive(b, a) always.
//
// A difference of two rounded products has the sign of the exact one unless it is 0: then the
// products' rounding errors decide. A true tie is broken by moving each vertex by (e, e²) with an e
// that is much smaller for each higher index: the leading term of the cross product of lower a and
// b is e_a b.v, then −e_a² b.u, −e_b a.v, −e_a² e_b. Since all tests speak of the same moved
// vertices, they fit together. Source: Edelsbrunner & Mücke (1990), Simulation of simplicity.
inline bool positive(double cross_ab, const Projected& a, const Projected& b) {
    if (cross_ab != 0.0) return cross_ab > 0.0;
    const double error_1 = std::fma(a.u, b.v, -(a.u * b.v));
    const double error_2 = std::fma(a.v, b.u, -(a.v * b.u));
    if (error_1 != error_2) return error_1 > error_2;
    if (b.id < a.id) return !positive(0.0, b, a);
    if (b.v != 0.0) return b.v > 0.0;
    if (b.u != 0.0) return b.u < 0.0;
    return a.v < 0.0;
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
