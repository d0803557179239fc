#include "radiosity/row_levels.h"

#include <cassert>

namespace tyndall::radiosity {
namespace {

class Numbering {
  public:
    Numbering(const Enclosure& enclosure, const Forest& forest, const Elements& elements,
              RowLevels& levels)
        : enclosure_(enclosure),
          varies_(enclosure.varies()),
          forest_(forest),
          elements_(elements),
          levels_(levels),
          measure_(elements.size() + 1) {
        levels_.parent.assign(measure_.size(), none);
    }

    // Gives the inner nodes of the tree below `root` their columns, children first: neighbours in
    // a tree are neighbours in memory.
    template <class Node>
    void number_tree(Node root, std::vector<std::uint32_t>& of_node,
                     const std::vector<std::uint32_t>& elements) {
        std::vector<std::pair<Node, bool>> open{{root, false}};
        while (!open.empty()) {
            const auto [node, children_done] = open.back();
            open.pop_back();
            if (const auto element = elements[node.value]; element != none) {
                of_node[node.value] = element;
                measure_[element] = measure(node);
                continue;
            }
            const auto& children = forest_[node].first_child;
            const Node second(children.value + 1ull);
            if (!children_done) {
                open.push_back({node, true});
                open.push_back({second, false});
                open.push_back({children, false});
                continue;
            }
            const auto column =
                append(varies_ ? measure_[of_node[children.value]] + measure_[of_node[second.value]]
                               : measure(node));
            of_node[node.value] = column;
            levels_.parent[of_node[children.value]] = column;
            levels_.parent[of_node[second.value]] = column;
        }
    }

    void number_clusters(const mesh::ClusterTree& tree, const std::vector<std::uint32_t>& of_root,
                         std::vector<std::uint32_t>& of_cluster) {
        of_cluster.assign(tree.clusters.size(), none);
        for (std::size_t c = tree.clusters.size(); c-- > 0;) {
            double sum = 0.0;
            for (const auto root : tree.members_of(mesh::ClusterId(c)))
                sum += measure_[of_root[root]];
            of_cluster[c] = append(sum);
        }
        for (std::size_t c = 0; c < tree.clusters.size(); ++c)
            if (const auto above = tree.clusters[c].parent; above.valid())
                levels_.parent[of_cluster[c]] = of_cluster[above.value];
        for (const auto root : tree.members)
            if (const auto above = tree.above[root]; above.valid())
                levels_.parent[of_root[root]] = of_cluster[above.value];
    }

    void compute_shares() {
        levels_.share.assign(measure_.size(), 0.0);
        for (std::size_t c = 0; c < measure_.size(); ++c)
            if (const auto above = levels_.parent[c]; above != none)
                levels_.share[c] = measure_[c] / measure_[above];
    }

  private:
    double measure(ZoneId zone) const {
        const double volume = forest_.volume(zone);
        if (!varies_) return volume;
        // A zone is met as often as it is dense.
        const auto medium = medium_of(enclosure_, forest_, zone);
        const double least = least_density * enclosure_.media[medium].extinction[0] + 1e-300;
        return volume * (rough_extinction(enclosure_, forest_, zone) + least);
    }
    double measure(PatchId patch) const { return forest_.area(patch); }
    std::uint32_t append(double measure) {
        measure_.push_back(measure);
        levels_.parent.push_back(none);
        return static_cast<std::uint32_t>(measure_.size() - 1);
    }

    const Enclosure& enclosure_;
    bool varies_;  // extinction, somewhere
    const Forest& forest_;
    const Elements& elements_;
    RowLevels& levels_;
    std::vector<double> measure_;  // of every column: area, volume, or ∫ κ dV where κ varies
};

}  // namespace

std::size_t RowLevels::memory() const {
    return 4 * (parent.size() + of_patch.size() + of_zone.size() + of_patch_cluster.size() +
                of_zone_cluster.size()) +
           8 * share.size();
}

std::vector<double> RowLevels::pull(std::span<const double> element_values) const {
    std::vector<double> values(columns(), 0.0);
    std::copy(element_values.begin(), element_values.end(), values.begin());
    for (std::size_t c = 0; c < values.size(); ++c)
        if (parent[c] != none) values[parent[c]] += share[c] * values[c];
    return values;
}

RowLevels make_row_levels(const Enclosure& enclosure, const Forest& forest,
                          const Elements& elements) {
    assert(elements.member_starts.empty());
    RowLevels levels;
    levels.of_patch.assign(forest.patch_count(), none);
    levels.of_zone.assign(forest.zone_count(), none);
    Numbering numbering(enclosure, forest, elements, levels);
    const OpticalTags tags(enclosure);
    for (std::size_t p = 0; p < tags.facet_sides.size(); ++p)
        if (tags.facet_sides[p] != none)
            numbering.number_tree(PatchId(p), levels.of_patch, elements.of_patch);
    for (std::size_t t = 0; t < tags.tets.size(); ++t)
        if (tags.tets[t] != none)
            numbering.number_tree(ZoneId(t), levels.of_zone, elements.of_zone);
    levels.clusters = mesh::make_clusters(enclosure.mesh, tags);
    numbering.number_clusters(levels.clusters.patches, levels.of_patch, levels.of_patch_cluster);
    numbering.number_clusters(levels.clusters.zones, levels.of_zone, levels.of_zone_cluster);
    numbering.compute_shares();
    return levels;
}

}  // namespace tyndall::radiosity
