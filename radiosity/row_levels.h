// Columns of exchange areas beyond the elements: coarser nodes that stand for the elements below
// them.
#pragma once

#include <span>
#include <vector>

#include "radiosity/elements.h"

namespace tyndall::radiosity {

// Columns 0 … n−1 are the elements, n is outside, from n + 1 on come inner nodes of the forest and
// clusters of its roots, children before their parents. An inner column's value is the mean of
// its children's, weighed by area or volume: unknowns are the elements' values alone.
struct RowLevels {
    std::vector<std::uint32_t> parent;  // column of the node above each column; none
    std::vector<double> share;  // of each column in its parent: area over area, volume over volume
    std::vector<std::uint32_t> of_patch, of_zone;  // column of a forest node; none
    mesh::Clusters clusters;
    std::vector<std::uint32_t> of_patch_cluster, of_zone_cluster;  // column of a cluster

    bool empty() const { return parent.empty(); }
    std::size_t columns() const { return parent.size(); }
    std::size_t memory() const;

    // The values of all columns, given those of the elements; outside's is 0.
    std::vector<double> pull(std::span<const double> element_values) const;
};

// The levels above elements that are the forest's leaves (mesh::make_clusters above its roots).
// Cost: O(nodes), and the clusters'.
RowLevels make_row_levels(const Enclosure& enclosure, const Forest& forest,
                          const Elements& elements);

}  // namespace tyndall::radiosity
