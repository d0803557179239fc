#include "mesh/clusters.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <unordered_map>

#include "mesh/cluster_graph.h"

namespace tyndall::mesh {
namespace {

bool lets_pass(const BaseMesh& mesh, std::size_t tet, int face) {
    const FacetId facet = mesh.tet_facets[tet][face];
    return mesh.neighbours[tet][face].valid() &&
           !(facet.valid() && mesh.facets[facet.value].opacity == Opacity::opaque);
}

// Turns pairs of items into lists of neighbours, ascending.
void link(ClusterGraph& graph, std::vector<std::array<std::uint32_t, 2>> pairs) {
    std::sort(pairs.begin(), pairs.end());
    graph.starts.assign(graph.size() + 1, 0);
    for (const auto& [item, neighbour] : pairs) {
        ++graph.starts[item + 1];
        graph.neighbours.push_back(neighbour);
    }
    for (std::size_t i = 0; i < graph.size(); ++i) graph.starts[i + 1] += graph.starts[i];
}

ClusterTree whole_clusters(const ClusterGraph& graph) {
    ClusterTree tree;
    tree.above.resize(graph.size());
    for (std::uint32_t item = 0; item < graph.size(); ++item)
        if (graph.tags[item] != untagged) tree.members.push_back(item);
    std::uint32_t begin = 0;
    for (const std::size_t end : Connected(graph)(tree.members)) {
        const ClusterId id(tree.clusters.size());
        tree.clusters.push_back({begin, static_cast<std::uint32_t>(end), {}, 0.0f});
        for (std::size_t k = begin; k < end; ++k) tree.above[tree.members[k]] = id;
        begin = static_cast<std::uint32_t>(end);
    }
    return tree;
}

}  // namespace

std::vector<std::uint32_t> light_tight_parts(const BaseMesh& mesh) {
    std::vector<std::uint32_t> parts(mesh.tets.size(), untagged);
    std::vector<std::size_t> open;
    std::uint32_t count = 0;
    for (std::size_t seed = 0; seed < mesh.tets.size(); ++seed) {
        if (parts[seed] != untagged) continue;
        parts[seed] = count;
        open.push_back(seed);
        while (!open.empty()) {
            const std::size_t tet = open.back();
            open.pop_back();
            for (int k = 0; k < 4; ++k) {
                if (!lets_pass(mesh, tet, k)) continue;
                const auto next = mesh.neighbours[tet][k].value;
                if (parts[next] != untagged) continue;
                parts[next] = count;
                open.push_back(next);
            }
        }
        ++count;
    }
    return parts;
}

ClusterGraph zone_graph(const BaseMesh& mesh, std::span<const std::uint32_t> tags) {
    ClusterGraph graph;
    graph.tags.assign(tags.begin(), tags.end());
    std::vector<std::array<std::uint32_t, 2>> pairs;
    for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
        graph.corners.insert(graph.corners.end(), mesh.tets[t].begin(), mesh.tets[t].end());
        for (int k = 0; k < 4; ++k) {
            if (tags[t] == untagged || !lets_pass(mesh, t, k)) continue;
            const auto next = mesh.neighbours[t][k].value;
            if (tags[next] == tags[t]) pairs.push_back({t, next});
        }
    }
    link(graph, std::move(pairs));
    return graph;
}

ClusterGraph patch_graph(const BaseMesh& mesh, std::span<const std::uint32_t> tags) {
    ClusterGraph graph;
    graph.corners_per_item = 3;
    graph.raised = 0.05;
    graph.tags.assign(tags.begin(), tags.end());
    const auto parts = light_tight_parts(mesh);
    const auto tet_at = [&](std::uint32_t side) { return mesh.facets[side / 2].tets[side % 2]; };
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> at_edge;
    std::vector<std::array<std::uint32_t, 2>> pairs;
    for (std::uint32_t s = 0; s < graph.size(); ++s) {
        const auto& corners = mesh.facets[s / 2].corners;
        graph.corners.insert(graph.corners.end(), corners.begin(), corners.end());
        if (!tet_at(s).valid()) graph.tags[s] = untagged;
        if (graph.tags[s] == untagged) continue;
        const Direction n = (s % 2 ? -1.0 : 1.0) * normal(mesh, FacetId(s / 2));
        for (int k = 0; k < 3; ++k) {
            const auto [a, b] = std::minmax(corners[k].value, corners[(k + 1) % 3].value);
            auto& users = at_edge[std::uint64_t(a) << 32 | b];
            for (const std::uint32_t other : users) {
                const Direction m = (other % 2 ? -1.0 : 1.0) * normal(mesh, FacetId(other / 2));
                if (graph.tags[other] != graph.tags[s] || glm::dot(n, m) < 1.0 - coplanar ||
                    parts[tet_at(other).value] != parts[tet_at(s).value])
                    continue;
                pairs.push_back({s, other});
                pairs.push_back({other, s});
            }
            users.push_back(s);
        }
    }
    link(graph, std::move(pairs));
    return graph;
}

std::vector<std::size_t> Connected::operator()(std::span<std::uint32_t> items) {
    ++call_;
    std::sort(items.begin(), items.end());
    for (const auto item : items) mark_[item] = call_;
    std::vector<std::uint32_t> sorted;
    std::vector<std::size_t> ends;
    sorted.reserve(items.size());
    for (const auto seed : items) {
        if (mark_[seed] != call_) continue;
        mark_[seed] = 0;
        sorted.push_back(seed);
        for (std::size_t k = sorted.size() - 1; k < sorted.size(); ++k)
            for (const auto next : graph_.neighbours_of(sorted[k]))
                if (mark_[next] == call_) {
                    mark_[next] = 0;
                    sorted.push_back(next);
                }
        ends.push_back(sorted.size());
    }
    std::copy(sorted.begin(), sorted.end(), items.begin());
    return ends;
}

Clusters make_clusters(const BaseMesh& mesh, const ClusterTags& tags) {
    return {split_clusters(mesh, zone_graph(mesh, tags.tets)),
            split_clusters(mesh, patch_graph(mesh, tags.facet_sides))};
}

Clusters make_whole_clusters(const BaseMesh& mesh, const ClusterTags& tags) {
    return {whole_clusters(zone_graph(mesh, tags.tets)),
            whole_clusters(patch_graph(mesh, tags.facet_sides))};
}

}  // namespace tyndall::mesh
