// The mesh that the adaptive loop grows: forest, surface meshes and the samples at its corners.
#pragma once

#include "mesh/surface_mesh.h"
#include "radiosity/samples.h"
#include "radiosity/shadow_boundaries.h"

namespace tyndall::radiosity {

// A zone is seen as an integral along chords. Its function keeps the mean, so that along a chord
// what is left has either sign: about half of the deviation from a constant remains, and a fifth
// of that from the linear function that fits best, whose sign changes more often, where the zone is
// thin [-].
inline constexpr double chord_share = 0.5, fitted_chord_share = 0.2;

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
    // The edge between two corners at corner_i + t (corner_j − corner_i); with a patch the one
    // beyond the edge.
    void bisect(ZoneId zone, std::array<int, 2> edge, double t);
    void bisect(PatchId patch, std::array<int, 2> edge, double t);

    // Direct light jumps at a vertex across a plane: from now on elements on either side have
    // samples of their own there.
    void mark(VertexId vertex, std::uint32_t plane_index, const ShadowPlane& plane);
    // Whether all these vertices lie on one such plane: what elements hold may differ across it.
    bool on_one_shadow(std::span<const VertexId> vertices) const;
    // The leaves across the edges of a patch, opposite its corners, on its surface side; none at a
    // border.
    std::array<PatchId, 3> neighbours(PatchId patch) const {
        return surfaces_.neighbours(forest_, patch);
    }
    // Samples of direct light at the corners, and at the middle of the edge between corners i and
    // j: on the element's own side of marked planes.
    std::array<SampleId, 4> lit_corners(ZoneId zone) { return lit_corners_of<4>(zone); }
    std::array<SampleId, 3> lit_corners(PatchId patch) { return lit_corners_of<3>(patch); }
    SampleId lit_middle(ZoneId zone, int i, int j) {
        return marks_.empty() ? middle(zone, i, j) : lit_middle_of<4>(zone, i, j);
    }
    SampleId lit_middle(PatchId patch, int i, int j) {
        return marks_.empty() ? middle(patch, i, j) : lit_middle_of<3>(patch, i, j);
    }

    // Samples of all other light, which does not jump.
    std::array<SampleId, 4> corners(ZoneId zone);
    std::array<SampleId, 3> corners(PatchId patch);
    SampleId middle(ZoneId zone, int i, int j) { return middle_of<4>(zone, i, j); }
    SampleId middle(PatchId patch, int i, int j) { return middle_of<3>(patch, i, j); }

    // Bisects the longest edges until none is longer than a size, or there are enough leaves.
    struct InitialSize {
        double longest_edge = 0.0;           // [m]
        std::size_t zones = 0, patches = 0;  // leaves
    };
    void refine_to(const InitialSize& size);

    // Goes on with the bisections of a forest that began as this one did.
    // Errors: mesh::InputError if it did not.
    void replay(const Forest& saved);

    std::size_t memory() const {
        return forest_.memory() + samples_.memory() + of_zone_.size() * sizeof(NodeSamples<4>) +
               of_patch_.size() * sizeof(NodeSamples<3>) + lit_of_zone_.memory() +
               lit_of_patch_.memory();
    }

  private:
    using Marks = std::vector<std::uint32_t>;  // plane indices, in the order they were set
    template <std::size_t count, class Node>
    std::array<SampleId, count> lit_corners_of(Node node);
    template <std::size_t count, class Node>
    SampleId lit_middle_of(Node node, int i, int j);
    template <class Node>
    SampleId lit(Node node, VertexId vertex, const Marks& marks);
    const Marks& marks_at(VertexId vertex) const;
    std::uint32_t mark_count(VertexId vertex) const {
        return vertex.value < mark_counts_.size() ? mark_counts_[vertex.value] : 0;
    }
    // Of a node, once it has been asked for: at its corners, then in the middle of its edges, (0,
    // 1) first; for other light than that of marked planes.
    template <std::size_t corners>
    struct NodeSamples {
        static constexpr std::size_t edges = corners * (corners - 1) / 2;
        std::array<SampleId, corners> at_corners{};
        std::array<VertexId, edges> middles{};
        std::array<SampleId, edges> in_middles{};
    };
    template <std::size_t corners, class Node>
    NodeSamples<corners>& samples_of(Node node);
    template <std::size_t corners, class Node>
    VertexId middle_vertex(Node node, int i, int j);
    template <std::size_t corners, class Node>
    SampleId middle_of(Node node, int i, int j);
    // Those of direct light, of nodes that have a marked vertex: they hold as long as there are no
    // more marks than there were.
    template <std::size_t corners>
    struct LitSamples {
        static constexpr std::size_t edges = corners * (corners - 1) / 2;
        std::array<SampleId, corners> at_corners{};
        std::array<SampleId, edges> in_middles{};
        std::uint32_t corner_marks = 0;
        std::array<std::uint32_t, edges> middle_marks{};
    };
    template <std::size_t corners>
    struct LitNodes {
        std::vector<std::uint32_t> entry;  // by node; 0: none
        std::vector<LitSamples<corners>> samples{1};
        std::size_t memory() const {
            return entry.size() * sizeof(std::uint32_t) +
                   samples.size() * sizeof(LitSamples<corners>);
        }
        template <class Node>
        LitSamples<corners>& of(Node node, std::size_t nodes);
    };
    LitNodes<4>& lit_nodes(ZoneId) { return lit_of_zone_; }
    LitNodes<3>& lit_nodes(PatchId) { return lit_of_patch_; }
    SampleId sample(ZoneId zone, VertexId vertex, std::uint32_t sides, Point x);
    SampleId sample(PatchId patch, VertexId vertex, std::uint32_t sides, Point x);

    const Enclosure& enclosure_;
    Forest forest_;
    mesh::SurfaceMeshes surfaces_;
    SampleSet samples_;
    std::vector<ZoneId> zones_;
    std::vector<PatchId> patches_;
    std::size_t zone_leaves_ = 0, patch_leaves_ = 0;
    std::unordered_map<std::uint32_t, Marks> marks_;              // of vertices
    std::vector<std::uint8_t> mark_counts_;                       // by vertex
    std::unordered_map<std::uint32_t, ShadowPlane> mark_planes_;  // by plane index
    std::vector<NodeSamples<4>> of_zone_;                         // by node
    std::vector<NodeSamples<3>> of_patch_;                        // by node
    LitNodes<4> lit_of_zone_;
    LitNodes<3> lit_of_patch_;
};

}  // namespace tyndall::radiosity
