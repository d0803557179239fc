// The hierarchy above the base mesh: clusters of base tets and clusters of facet sides.
//
// A base mesh has as many tets as its surfaces ask for. Above it the tree of elements goes on
// upwards, to the one zone a medium and the one patch a polygon that a solve may start from, and
// to the coarser levels that a far receiver may exchange light with.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "mesh/base_mesh.h"

namespace tyndall::mesh {

using ClusterId = Id<struct ClusterTag>;

inline constexpr std::uint32_t untagged = std::numeric_limits<std::uint32_t>::max();

// A cluster's members are members[begin … end) of its tree.
struct Cluster {
    std::uint32_t begin = 0, end = 0;
    ClusterId parent;    // none: a root
    float extent = 0.0;  // the largest of its widths along 13 directions [m]
};

// Every cluster has at least two members, children or not; a member that fits no cluster has none.
struct ClusterTree {
    std::vector<std::uint32_t> members;  // base tets, or facet sides (2 f + side)
    std::vector<Cluster> clusters;       // parents before their children
    std::vector<ClusterId> above;        // of each base tet or facet side: its smallest cluster

    std::span<const std::uint32_t> members_of(ClusterId id) const {
        const Cluster& c = clusters[id.value];
        return std::span(members).subspan(c.begin, c.end - c.begin);
    }
};

struct Clusters {
    ClusterTree zones, patches;
};

// What base tets and facet sides (2 f + side) have in common, as the caller sees it: the medium,
// the side of a surface. Untagged ones are in no cluster.
struct ClusterTags {
    std::span<const std::uint32_t> tets, facet_sides;
};

// Clusters that may stand for their members in the eyes of any receiver.
//   A zone cluster: tets of one tag, connected through faces on which no opaque facet lies, into
//     whose hull no opaque facet enters: so none has a wall inside, or the free edge of one.
//   A patch cluster: coplanar facet sides of one tag and one part, connected through edges, and no
//     other opaque facet enters its hull, or stands on it.
// The hull is the members' bounding polytope with 26 faces: it is larger than the convex hull, so
// that some clusters are refused that need not be. Facets of a curved convex body may enter it a
// little if a zone cluster lies on one side of them, with normals within 60 degrees of each other.
// Method: from the top. A set that a facet enters is split by the plane of the largest such facet,
//   else in the middle of its longest side; then into its connected pieces.
// Cost: O(n log n) and, at every level, the facets that touch a set's hull.
Clusters make_clusters(const BaseMesh& mesh, const ClusterTags& tags);

// The coarsest elements of all, one cluster each, without children:
//   zones: the tets of one tag that are connected through faces that let light pass. Walls may
//     stand in one: it can begin a solve, but not stand for its members in a finer one.
//   patches: coplanar facet sides of one tag and part, connected through edges: the sides of the
//     input polygons, split where a partition closes.
// Tets and facet sides that are alone are clusters of one.
Clusters make_whole_clusters(const BaseMesh& mesh, const ClusterTags& tags);

// Of each base tet: the light-tight part of the mesh it is in. Tets are in one part if a way leads
// from one to the other that meets no opaque facet.
std::vector<std::uint32_t> light_tight_parts(const BaseMesh& mesh);

}  // namespace tyndall::mesh
