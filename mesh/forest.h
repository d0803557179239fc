// The bisection forest: in every base tet and on every facet side a binary tree. The only
// refinement is "bisect an edge at t": a child of a tetrahedron is a tetrahedron, a child of a
// triangle a triangle.
//
// Children nest exactly, hanging nodes are harmless, and every inner node is an element at a
// coarser level of detail. The walk descends a tree as a BSP: one split plane a node clips the
// ray's interval and leaf faces are never tested, so that rounding opens no gaps. Source: Rivara
// (1984); Rushmeier (1988) for volumes.
#pragma once

#include <array>
#include <unordered_map>
#include <vector>

#include "mesh/base_mesh.h"
#include "mesh/walk.h"

namespace tyndall::mesh {

// The base vertices whose weights are not zero at a forest vertex, ascending, padded with none: the
// smallest base vertex, edge, facet or tet that holds it.
using Carrier = std::array<VertexId, 4>;

// 64 bytes, one cache line. An inner node keeps its split plane: dot(normal, x) + offset is
// negative in the first child, positive in the second.
struct ZoneNode {
    Direction plane_normal{0.0};
    double plane_offset = 0.0;
    std::array<VertexId, 4> corners;  // positively oriented
    ZoneId first_child;               // the second follows it; none: a leaf
    ZoneId parent;                    // none: a base tet
    std::uint32_t level = 0;          // bisections since the base tet
    float longest_edge = 0.0f;        // [m]
};

struct PatchNode {
    Direction plane_normal{0.0};  // of the plane that holds the split line, across the triangle
    double plane_offset = 0.0;
    std::array<VertexId, 3> corners;  // counter-clockwise seen from the side it faces
    PatchId first_child;
    PatchId parent;
    std::uint32_t level = 0;
    float longest_edge = 0.0f;  // [m]
};

// The node that each root stands for: zone nodes 0 … tets−1 are the base tets; patch nodes
// 2 f (front) and 2 f + 1 (back) are the sides of base facet f.
inline ZoneId root_zone(TetId tet) {
    return ZoneId(tet.value);
}
inline PatchId root_patch(FacetId facet, Side side) {
    return PatchId(2ull * facet.value + (side == Side::back));
}

class Forest {
  public:
    Forest() = default;
    // The forest of roots only. Cost: O(tets + facets).
    explicit Forest(const BaseMesh& base);

    // Bisects the edge between corners i and j of a leaf at corner_i + t (corner_j − corner_i).
    // The first child keeps corner i, the second corner j. Returns the first child.
    // Everywhere t is taken as place(t).
    ZoneId bisect(ZoneId zone, int i, int j, double t = 0.5);
    PatchId bisect(PatchId patch, int i, int j, double t = 0.5);

    // The vertex on an edge, made if it does not exist: tets and triangles around an edge share it.
    VertexId vertex_on_edge(VertexId a, VertexId b, double t = 0.5);
    // t to a multiple of 2^-52. Then 1 − t is exact and 1 − (1 − t) is t, so that an edge has the
    // same vertex from either end. Whoever computes a t must still do so from the same end always.
    static double place(double t) { return (1.0 + t) - 1.0; }

    const ZoneNode& operator[](ZoneId id) const { return zones_[id.value]; }
    const PatchNode& operator[](PatchId id) const { return patches_[id.value]; }
    Point point(VertexId id) const { return points_[id.value]; }
    const Carrier& carrier(VertexId id) const { return carriers_[id.value]; }
    // Base tet, or facet side (2 f + side), that a node lies in.
    TetId base_tet(ZoneId id) const { return TetId(zone_roots_[id.value]); }
    std::uint32_t base_facet_side(PatchId id) const { return patch_roots_[id.value]; }

    std::size_t zone_count() const { return zones_.size(); }  // nodes, inner ones too
    std::size_t patch_count() const { return patches_.size(); }
    std::size_t vertex_count() const { return points_.size(); }
    bool is_leaf(ZoneId id) const { return !zones_[id.value].first_child.valid(); }
    bool is_leaf(PatchId id) const { return !patches_[id.value].first_child.valid(); }

    Point centroid(ZoneId id) const;
    Point centroid(PatchId id) const;
    double volume(ZoneId id) const;  // [m^3]
    double area(PatchId id) const;   // [m^2]
    // The two corner indices of the longest edge; ties go to the lower vertex indices.
    std::array<int, 2> longest_edge(ZoneId id) const;
    std::array<int, 2> longest_edge(PatchId id) const;

    // The leaf below `patch` that holds x (which lies on it).
    PatchId leaf_at(PatchId patch, Point x) const;
    // The leaf below `zone` that holds x.
    ZoneId leaf_at(ZoneId zone, Point x) const;

    // Bytes held.
    std::size_t memory() const;

    // For solution files: the bisections in order, from which the same forest is built again.
    struct Bisection {
        std::uint32_t node;  // zone, or patch + 2^31
        std::uint8_t i, j;   // corners of the edge
        double t;
    };
    const std::vector<Bisection>& history() const { return history_; }
    void replay(const std::vector<Bisection>& history);
    // The edges that the vertices beyond the base mesh's lie on, in the vertices' order. Making
    // them by vertex_on_edge in this order before a replay gives every vertex its old index.
    struct VertexEdge {
        VertexId a, b;
        double t;
    };
    const std::vector<VertexEdge>& vertex_edges() const { return vertex_edges_; }

  private:
    float edge_bound(const VertexId* corners, int count) const;
    template <class Node>
    std::uint32_t split(std::vector<Node>& nodes, std::vector<std::uint32_t>& roots,
                        std::uint32_t index, int i, int j, double t, Direction normal);

    std::vector<Point> points_;
    std::vector<Carrier> carriers_;
    std::vector<ZoneNode> zones_;
    std::vector<PatchNode> patches_;
    std::vector<std::uint32_t> zone_roots_, patch_roots_;
    struct EdgeKey {
        VertexId a, b;
        double t;
        bool operator==(const EdgeKey&) const = default;
    };
    struct EdgeHash {
        std::size_t operator()(const EdgeKey& key) const noexcept;
    };
    std::unordered_map<EdgeKey, VertexId, EdgeHash> edge_vertices_;
    std::vector<VertexEdge> vertex_edges_;
    std::vector<Bisection> history_;
};

// Clips [t_in, t_out] of a ray by the trees below `zone`, down to leaves or to where
// `stop_at(ZoneId, t_in)` is true; on_zone(ZoneId, t_in, t_out) → bool is called in order along the
// ray; false stops.
template <class StopAt, class OnZone>
bool descend(const Forest& forest, ZoneId zone, const Ray& ray, double t_in, double t_out,
             StopAt&& stop_at, OnZone&& on_zone);

// The walk through the leaves (or coarser nodes, see descend) of the forest.
template <class StopAt, class OnZone>
WalkEnd walk_zones(const BaseMesh& base, const Forest& forest, const Ray& ray, WalkStart start,
                   StopAt&& stop_at, OnZone&& on_zone) {
    return walk(base, ray, start, [&](TetId tet, double t_in, double t_out) {
        return descend(forest, root_zone(tet), ray, t_in, t_out, stop_at, on_zone);
    });
}

inline constexpr auto at_leaves = [](ZoneId, double) { return false; };

template <class StopAt, class OnZone>
bool descend(const Forest& forest, ZoneId zone, const Ray& ray, double t_in, double t_out,
             StopAt&& stop_at, OnZone&& on_zone) {
    struct Pending {
        ZoneId zone;
        double t_out;
    };
    std::array<Pending, 128> stack;
    int depth = 0;
    for (;;) {
        const ZoneNode& node = forest[zone];
        if (!node.first_child.valid() || depth == 128 || stop_at(zone, t_in)) {
            if (t_out > t_in && !on_zone(zone, t_in, t_out)) return false;
            if (depth == 0) return true;
            t_in = std::max(t_in, t_out);
            zone = stack[--depth].zone;
            t_out = stack[depth].t_out;
            continue;
        }
        const double slope = glm::dot(node.plane_normal, ray.direction);
        const double start = glm::dot(node.plane_normal, ray.origin) + node.plane_offset;
        const double at_in = start + t_in * slope, at_out = start + t_out * slope;
        const ZoneId negative = node.first_child, positive(node.first_child.value + 1ull);
        if (at_in <= 0.0 && at_out <= 0.0) {
            zone = negative;
        } else if (at_in >= 0.0 && at_out >= 0.0) {
            zone = positive;
        } else {
            const double t = std::clamp(-start / slope, t_in, t_out);
            stack[depth++] = {at_in < 0.0 ? positive : negative, t_out};
            zone = at_in < 0.0 ? negative : positive;
            t_out = t;
        }
    }
}

}  // namespace tyndall::mesh
