// The bisection trees of zones in single precision and packed: walks along many rays are bound by
// memory, and this is a third of the forest's nodes.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "mesh/forest.h"
#include "radiosity/elements.h"

namespace tyndall::radiosity {

struct PackedZone {
    float plane[4];       // normal and offset of an inner node's split
    std::uint32_t child;  // first child; none: a leaf
    float longest_edge;   // [m]
};

// By node. Later bisections of the forest are not seen. Cost: O(nodes).
inline std::vector<PackedZone> packed_zones(const Forest& forest) {
    std::vector<PackedZone> nodes(forest.zone_count());
    for (std::size_t z = 0; z < nodes.size(); ++z) {
        const auto& node = forest[ZoneId(z)];
        const auto& n = node.plane_normal;
        nodes[z] = {{float(n.x), float(n.y), float(n.z), float(node.plane_offset)},
                    node.first_child.value,
                    node.longest_edge};
    }
    return nodes;
}

// A ray in the precision of packed zones.
struct PackedRay {
    float origin[3], direction[3];

    PackedRay() = default;
    PackedRay(Point from, Direction d)
        : origin{float(from.x), float(from.y), float(from.z)},
          direction{float(d.x), float(d.y), float(d.z)} {}
    explicit PackedRay(const mesh::Ray& ray) : PackedRay(ray.origin, ray.direction) {}
};

inline float dot(const float* a, const float* b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Purpose: what a ray crosses of a root between two distances, in order and without gaps: leaves,
//   and nodes that `look` finds enough.
// `nodes[k]`: something with a plane and a child as PackedZone has them. `look(k, node, t_in)` is
//   called for every node that is met, leaves as well, and says whether it stands for those below.
//   `visit(k, node, t_in, t_out)`, t_in ≤ t_out; the walk ends, and returns false, when it does.
template <class Nodes, class Look, class Visit>
bool descend_packed(const Nodes& nodes, std::uint32_t root, const PackedRay& ray, float t_in,
                    float t_out, Look&& look, Visit&& visit) {
    struct Pending {
        std::uint32_t node;
        float t_out;
    };
    std::array<Pending, 128> stack;
    int depth = 0;
    std::uint32_t at = root;
    for (;;) {
        const auto& node = nodes[at];
        const bool enough = look(at, node, t_in);
        if (node.child == none || enough || depth == 128) {
            if (!visit(at, node, t_in, t_out)) return false;
            if (depth == 0) return true;
            t_in = std::max(t_in, t_out);
            at = stack[--depth].node;
            t_out = stack[depth].t_out;
            continue;
        }
        const float slope = dot(node.plane, ray.direction);
        const float start = dot(node.plane, ray.origin) + node.plane[3];
        const float at_in = start + t_in * slope, at_out = start + t_out * slope;
        if (at_in <= 0.0f && at_out <= 0.0f) {
            at = node.child;
        } else if (at_in >= 0.0f && at_out >= 0.0f) {
            at = node.child + 1;
        } else {
            const float t = std::clamp(-start / slope, t_in, t_out);
            stack[depth++] = {at_in < 0.0f ? node.child + 1 : node.child, t_out};
            at = at_in < 0.0f ? node.child : node.child + 1;
            t_out = t;
        }
    }
}

}  // namespace tyndall::radiosity
