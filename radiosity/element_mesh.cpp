#include "radiosity/element_mesh.h"

#include <queue>

namespace tyndall::radiosity {
namespace {

std::vector<std::uint32_t> surface_groups(const Enclosure& enclosure) {
    std::vector<std::uint32_t> groups;
    for (const auto& sides : enclosure.facet_sides)
        groups.insert(groups.end(), {sides[0], sides[1]});
    return groups;
}

}  // namespace

ElementMesh::ElementMesh(const Enclosure& enclosure)
    : enclosure_(enclosure),
      forest_(enclosure.mesh),
      surfaces_(forest_, surface_groups(enclosure)),
      samples_(enclosure, forest_) {
    for (std::size_t z = 0; z < forest_.zone_count(); ++z)
        if (medium_of(enclosure, forest_, ZoneId(z)) != none) zones_.push_back(ZoneId(z));
    for (std::size_t p = 0; p < forest_.patch_count(); ++p)
        if (side_of(enclosure, forest_, PatchId(p)) != none) patches_.push_back(PatchId(p));
    zone_leaves_ = zones_.size();
    patch_leaves_ = patches_.size();
}

void ElementMesh::bisect(ZoneId zone, std::array<int, 2> edge) {
    const ZoneId first = forest_.bisect(zone, edge[0], edge[1]);
    zones_.push_back(first);
    zones_.push_back(ZoneId(first.value + 1ull));
    ++zone_leaves_;
}

void ElementMesh::bisect(PatchId patch) {
    const std::size_t before = patches_.size();
    surfaces_.refine(forest_, patch, &patches_);
    patch_leaves_ += (patches_.size() - before) / 2;
}

std::array<SampleId, 4> ElementMesh::corners(ZoneId zone) {
    const auto vertices = forest_[zone].corners;
    const TetId tet = forest_.base_tet(zone);
    std::array<SampleId, 4> result;
    for (int k = 0; k < 4; ++k) result[k] = samples_.in_zone(vertices[k], tet);
    return result;
}

std::array<SampleId, 3> ElementMesh::corners(PatchId patch) {
    const auto vertices = forest_[patch].corners;
    const auto side = forest_.base_facet_side(patch);
    std::array<SampleId, 3> result;
    for (int k = 0; k < 3; ++k) result[k] = samples_.on_patch(vertices[k], side);
    return result;
}

SampleId ElementMesh::middle(ZoneId zone, int i, int j) {
    const auto& vertices = forest_[zone].corners;
    const VertexId vertex = forest_.vertex_on_edge(vertices[i], vertices[j]);
    return samples_.in_zone(vertex, forest_.base_tet(zone));
}

SampleId ElementMesh::middle(PatchId patch, int i, int j) {
    const auto& vertices = forest_[patch].corners;
    const VertexId vertex = forest_.vertex_on_edge(vertices[i], vertices[j]);
    return samples_.on_patch(vertex, forest_.base_facet_side(patch));
}

void ElementMesh::refine_to(const InitialSize& size) {
    using Entry = std::pair<float, std::uint32_t>;  // longest edge, node
    // Longest first, lower node first among equals: as even as bisection can make the mesh.
    const auto shorter = [](const Entry& a, const Entry& b) {
        return a.first != b.first ? a.first < b.first : a.second > b.second;
    };
    std::priority_queue<Entry, std::vector<Entry>, decltype(shorter)> zones(shorter),
        patches(shorter);
    for (const ZoneId z : zones_)
        if (forest_.is_leaf(z)) zones.push({forest_[z].longest_edge, z.value});
    for (const PatchId p : patches_)
        if (forest_.is_leaf(p)) patches.push({forest_[p].longest_edge, p.value});
    while (!zones.empty() && zones.top().first > size.longest_edge && zone_leaves_ < size.zones) {
        const ZoneId zone(zones.top().second);
        zones.pop();
        bisect(zone, forest_.longest_edge(zone));
        for (const std::uint64_t k : {0, 1}) {
            const ZoneId child(forest_[zone].first_child.value + k);
            zones.push({forest_[child].longest_edge, child.value});
        }
    }
    while (!patches.empty() && patches.top().first > size.longest_edge &&
           patch_leaves_ < size.patches) {
        const PatchId patch(patches.top().second);
        patches.pop();
        if (!forest_.is_leaf(patch)) continue;  // bisected with a neighbour
        const std::size_t before = patches_.size();
        bisect(patch);
        for (std::size_t k = before; k < patches_.size(); ++k)
            patches.push({forest_[patches_[k]].longest_edge, patches_[k].value});
    }
}

}  // namespace tyndall::radiosity
