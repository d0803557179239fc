// The mesh that the adaptive loop grows: forest, surface meshes and the samples at its corners.
#pragma once

#include "mesh/surface_mesh.h"
#include "radiosity/samples.h"

namespace tyndall::radiosity {

// Only nodes that light can reach are listed: zones in a medium, patches on a side that faces a
// region which is not solid. Lists grow in the order of creation; a node that has been bisected
// stays in them.
class ElementMesh {
  public:
    explicit ElementMesh(const Enclosure& enclosure);

    const Forest& forest() const { return forest_; }
    Forest& forest() { return forest_; }
    SampleSet& samples() { return samples_; }
    const SampleSet& samples() const { return samples_; }
    const std::vector<ZoneId>& zones() const { return zones_; }
    const std::vector<PatchId>& patches() const { return patches_; }
    std::size_t leaf_count() const { return zone_leaves_ + patch_leaves_; }
    std::size_t zone_leaf_count() const { return zone_leaves_; }
    std::size_t patch_leaf_count() const { return patch_leaves_; }

    void bisect(ZoneId zone, std::array<int, 2> edge);
    void bisect(PatchId patch);  // its longest edge, with the neighbours that conformity asks for

    // Samples at the corners, and at the middle of the edge between corners i and j.
    std::array<SampleId, 4> corners(ZoneId zone);
    std::array<SampleId, 3> corners(PatchId patch);
    SampleId middle(ZoneId zone, int i, int j);
    SampleId middle(PatchId patch, int i, int j);

    // Bisects the longest edges until none is longer than a size, or there are enough leaves.
    struct InitialSize {
        double longest_edge = 0.0;           // [m]
        std::size_t zones = 0, patches = 0;  // leaves
    };
    void refine_to(const InitialSize& size);

    std::size_t memory() const { return forest_.memory() + samples_.memory(); }

  private:
    const Enclosure& enclosure_;
    Forest forest_;
    mesh::SurfaceMeshes surfaces_;
    SampleSet samples_;
    std::vector<ZoneId> zones_;
    std::vector<PatchId> patches_;
    std::size_t zone_leaves_ = 0, patch_leaves_ = 0;
};

}  // namespace tyndall::radiosity
