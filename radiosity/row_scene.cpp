#include "radiosity/row_scene.h"

namespace tyndall::radiosity {

template <class NodeId>
RowScene::Tree RowScene::pack(const std::vector<std::uint32_t>& tags,
                              const std::vector<std::uint32_t>& elements,
                              const std::vector<std::uint32_t>* columns) const {
    Tree tree;
    tree.pairs.resize((tags.size() + 1) / 2);
    struct Open {
        NodeId node;
        std::uint32_t place;
    };
    std::vector<Open> open;
    for (std::size_t root = 0; root < tags.size(); ++root) {
        if (tags[root] == none) continue;
        open.push_back({NodeId(root), static_cast<std::uint32_t>(root)});
        while (!open.empty()) {
            const auto [id, place] = open.back();
            open.pop_back();
            const auto& node = forest_[id];
            const auto element = elements[id.value];
            Node packed{{}, none, columns ? (*columns)[id.value] : element, node.longest_edge};
            if (element == none) {
                const Direction& n = node.plane_normal;
                packed.plane[0] = static_cast<float>(n.x);
                packed.plane[1] = static_cast<float>(n.y);
                packed.plane[2] = static_cast<float>(n.z);
                packed.plane[3] = static_cast<float>(node.plane_offset + glm::dot(n, centre_));
                packed.child = static_cast<std::uint32_t>(2 * tree.pairs.size());
                tree.pairs.emplace_back();
                open.push_back({NodeId(node.first_child.value + 1ull), packed.child + 1});
                open.push_back({node.first_child, packed.child});
            }
            tree[place] = packed;
        }
    }
    return tree;
}

RowScene::Above RowScene::pack(const mesh::ClusterTree& tree,
                               const std::vector<std::uint32_t>& columns) {
    Above above;
    for (const auto cluster : tree.above) above.of_root.push_back(cluster.value);
    for (std::size_t c = 0; c < tree.clusters.size(); ++c)
        above.clusters.push_back(
            {columns[c], tree.clusters[c].parent.value, tree.clusters[c].extent});
    return above;
}

RowScene::RowScene(const Discretization& d, const RowLevels* levels,
                   std::span<const std::size_t> bands, double detail)
    : mesh_(d.enclosure.mesh),
      forest_(d.forest),
      centre_(0.5 * (mesh_.hull_min + mesh_.hull_max)),
      // Below every size: no node but the elements is ever small enough.
      detail_(levels ? static_cast<float>(detail) : 0.0f),
      outside_(static_cast<std::uint32_t>(d.elements.outside())) {
    const OpticalTags tags(d.enclosure);
    zones_ = pack<ZoneId>(tags.tets, d.elements.of_zone, levels ? &levels->of_zone : nullptr);
    patches_ =
        pack<PatchId>(tags.facet_sides, d.elements.of_patch, levels ? &levels->of_patch : nullptr);
    if (levels) {
        zones_above_ = pack(levels->clusters.zones, levels->of_zone_cluster);
        patches_above_ = pack(levels->clusters.patches, levels->of_patch_cluster);
    }
    if (d.enclosure.has_mirrors())
        for (const auto side : tags.facet_sides)
            for (const std::size_t band : bands)
                mirrors_.push_back(side == none ? 0.0 : d.enclosure.sides[side].mirrored(band));
    const bool varies = d.enclosure.varies();
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t)
        for (const std::size_t band : bands) {
            const bool element = tags.tets[t] != none;
            extinction_.push_back(
                element ? static_cast<float>(d.enclosure.extinction(TetId(t), band)) : 0.0f);
            if (varies) varying_.push_back(element ? d.enclosure.varying(TetId(t), band) : nullptr);
        }
}

std::size_t RowScene::memory() const {
    return sizeof(Pair) * (zones_.pairs.capacity() + patches_.pairs.capacity()) +
           sizeof(Cluster) * (zones_above_.clusters.size() + patches_above_.clusters.size()) +
           sizeof(void*) * varying_.size() + 8 * mirrors_.size() +
           4 * (extinction_.size() + zones_above_.of_root.size() + patches_above_.of_root.size());
}

}  // namespace tyndall::radiosity
