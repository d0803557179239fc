// What clusters are made of: items (base tets or facet sides) and which of them are adjacent.
#pragma once

#include <span>
#include <vector>

#include "mesh/clusters.h"

namespace tyndall::mesh {

struct ClusterGraph {
    int corners_per_item = 4;
    std::vector<VertexId> corners;    // of every item
    std::vector<std::uint32_t> tags;  // of every item
    std::vector<std::size_t> starts;  // into `neighbours`
    std::vector<std::uint32_t> neighbours;
    double raised = 0.0;  // share of a set's extent that its hull is raised by along
                          // its normal, so that what stands on it enters it [-]

    std::size_t size() const { return tags.size(); }
    std::span<const VertexId> corners_of(std::uint32_t item) const {
        const auto count = static_cast<std::size_t>(corners_per_item);
        return std::span(corners).subspan(item * count, count);
    }
    std::span<const std::uint32_t> neighbours_of(std::uint32_t item) const {
        return std::span(neighbours).subspan(starts[item], starts[item + 1] - starts[item]);
    }
};

ClusterGraph zone_graph(const BaseMesh& mesh, std::span<const std::uint32_t> tags);
ClusterGraph patch_graph(const BaseMesh& mesh, std::span<const std::uint32_t> tags);

// Sorts `items` so that connected ones are consecutive, in the order of their first members;
// returns the pieces' ends.
class Connected {
  public:
    explicit Connected(const ClusterGraph& graph) : graph_(graph), mark_(graph.size(), 0) {}
    std::vector<std::size_t> operator()(std::span<std::uint32_t> items);

  private:
    const ClusterGraph& graph_;
    std::vector<std::uint32_t> mark_;  // of the call that an item waits in; 0: none
    std::uint32_t call_ = 0;
};

// The tree of make_clusters for one graph.
ClusterTree split_clusters(const BaseMesh& mesh, const ClusterGraph& graph);

}  // namespace tyndall::mesh
