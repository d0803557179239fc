// The working meshes of the surfaces: one manifold OpenMesh a side of a surface, refined
// conformingly, so that no T-junction opens within a surface.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "mesh/forest.h"

namespace tyndall::mesh {

class SurfaceMeshes {
  public:
    // `groups`: for each facet side (2 f + side) the side of a surface it belongs to; `no_group`
    // where no light can be. Facet sides of one group that do not form a manifold are spread over
    // several meshes.
    static constexpr std::uint32_t no_group = 0xffffffffu;
    SurfaceMeshes(const Forest& forest, std::span<const std::uint32_t> groups);
    ~SurfaceMeshes();

    // Bisects a leaf by its longest edge, and the triangle beyond that edge with it; where that one
    // has a longer edge it is refined first. Every new leaf is appended to `made` (if not null).
    // Cost: O(1) amortised. Source: Rivara (1984), longest-edge propagation.
    void refine(Forest& forest, PatchId patch, std::vector<PatchId>* made = nullptr);

    // Bisects a leaf at corner_i + t (corner_j − corner_i), and with it the triangle beyond that
    // edge.
    void split(Forest& forest, PatchId patch, int i, int j, double t,
               std::vector<PatchId>* made = nullptr);

    // The leaves across the edges of a leaf, opposite its corners; none at a border.
    std::array<PatchId, 3> neighbours(const Forest& forest, PatchId patch) const;

  private:
    struct Meshes;
    std::unique_ptr<Meshes> meshes_;
};

}  // namespace tyndall::mesh
