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

// A ray in the precision of packed zones.
struct PackedRay {
    float origin[3], direction[3];

    explicit PackedRay(const mesh::Ray& ray)
        : origin{float(ray.origin.x), float(ray.origin.y), float(ray.origin.z)},
          direction{float(ray.direction.x), float(ray.direction.y), float(ray.direction.z)} {}
};

inline float dot(const float* a, const float* b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

class PackedZones {
  public:
    // Later bisections of the forest are not seen. Cost: O(nodes).
    explicit PackedZones(const Forest& forest) : nodes_(forest.zone_count()) {
        for (std::size_t z = 0; z < nodes_.size(); ++z) {
            const auto& node = forest[ZoneId(z)];
            const auto& n = node.plane_normal;
            nodes_[z] = {{float(n.x), float(n.y), float(n.z), float(node.plane_offset)},
                         node.first_child.value,
                         node.longest_edge};
        }
    }

    std::size_t size() const { return nodes_.size(); }

    // Calls `visit(zone, is_leaf, t_in, t_out)` for what the ray crosses of a base tet between two
    // distances, in order: leaves, and nodes for which `enough(longest edge, t_in)`. Distances
    // follow each other without gaps. Ends, and returns false, when `visit` does. `prefetch(zone)`
    // is told of every node before it is looked at.
    template <class Prefetch, class Enough, class Visit>
    bool descend(TetId tet, const PackedRay& ray, float t_in, float t_out, Prefetch&& prefetch,
                 Enough&& enough, Visit&& visit) const {
        struct Pending {
            std::uint32_t zone;
            float t_out;
        };
        std::array<Pending, 128> stack;
        int depth = 0;
        std::uint32_t zone = tet.value;
        for (;;) {
            const PackedZone& node = nodes_[zone];
            prefetch(zone);
            const bool is_leaf = node.child == none;
            if (is_leaf || depth == 128 || enough(node.longest_edge, t_in)) {
                if (t_out > t_in && !visit(zone, is_leaf, t_in, t_out)) return false;
                if (depth == 0) return true;
                t_in = std::max(t_in, t_out);
                zone = stack[--depth].zone;
                t_out = stack[depth].t_out;
                continue;
            }
            const float slope = dot(node.plane, ray.direction);
            const float start = dot(node.plane, ray.origin) + node.plane[3];
            const float at_in = start + t_in * slope, at_out = start + t_out * slope;
            if (at_in <= 0.0f && at_out <= 0.0f) {
                zone = node.child;
            } else if (at_in >= 0.0f && at_out >= 0.0f) {
                zone = node.child + 1;
            } else {
                const float t = std::clamp(-start / slope, t_in, t_out);
                stack[depth++] = {at_in < 0.0f ? node.child + 1 : node.child, t_out};
                zone = at_in < 0.0f ? node.child : node.child + 1;
                t_out = t;
            }
        }
    }

  private:
    std::vector<PackedZone> nodes_;
};

}  // namespace tyndall::radiosity
