#include "mesh/wall_openings.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <span>

namespace tyndall::mesh {
namespace {

constexpr double walled = 0.9;  // of an opening's outline, at least

struct Edge {
    std::array<std::uint32_t, 2> ends;
    FacetId facet;
};

// Edges of all facets, those with the same ends one after another.
std::vector<Edge> sorted_edges(const BaseMesh& mesh) {
    std::vector<Edge> edges;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
        const auto& c = mesh.facets[f].corners;
        for (int k = 0; k < 3; ++k) {
            const auto [a, b] = std::minmax(c[k].value, c[(k + 1) % 3].value);
            edges.push_back({{a, b}, FacetId(f)});
        }
    }
    std::ranges::stable_sort(edges, {}, &Edge::ends);
    return edges;
}

// visit(facets) for every edge: those that have it.
template <class Visit>
void for_each_edge(const std::vector<Edge>& edges, Visit&& visit) {
    for (auto begin = edges.begin(); begin != edges.end();) {
        const auto end =
            std::find_if(begin, edges.end(), [&](const Edge& e) { return e.ends != begin->ends; });
        visit(std::span(begin, end));
        begin = end;
    }
}

class Leaders {
  public:
    explicit Leaders(std::size_t count) : of_(count) { std::iota(of_.begin(), of_.end(), 0u); }
    std::uint32_t find(FacetId facet) {
        std::uint32_t f = facet.value;
        while (of_[f] != f) f = of_[f] = of_[of_[f]];
        return f;
    }
    void join(FacetId a, FacetId b) { of_[find(a)] = find(b); }

  private:
    std::vector<std::uint32_t> of_;
};

}  // namespace

bool has_interfaces(const BaseMesh& mesh) {
    return std::ranges::any_of(mesh.facets,
                               [](const BaseFacet& f) { return f.opacity == Opacity::interface; });
}

std::vector<std::vector<FacetId>> wall_openings(const BaseMesh& mesh) {
    const auto is_interface = [&](FacetId f) {
        return mesh.facets[f.value].opacity == Opacity::interface;
    };
    const std::vector<Edge> edges = sorted_edges(mesh);
    Leaders leaders(mesh.facets.size());
    for_each_edge(edges, [&](std::span<const Edge> at) {
        for (const Edge& a : at)
            for (const Edge& b : at) {
                if (!(a.facet < b.facet) || !is_interface(a.facet) || !is_interface(b.facet))
                    continue;
                const double cosine = glm::dot(normal(mesh, a.facet), normal(mesh, b.facet));
                if (std::abs(cosine) > 1.0 - coplanar) leaders.join(a.facet, b.facet);
            }
    });
    std::vector<double> outline(mesh.facets.size(), 0.0), along_walls(mesh.facets.size(), 0.0);
    for_each_edge(edges, [&](std::span<const Edge> at) {
        const auto& [a, b] = at.front().ends;
        const double length = glm::distance(mesh.points[a], mesh.points[b]);
        const bool wall =
            std::ranges::any_of(at, [&](const Edge& e) { return !is_interface(e.facet); });
        for (const Edge& e : at) {
            if (!is_interface(e.facet)) continue;
            const std::uint32_t group = leaders.find(e.facet);
            const bool within = std::ranges::count_if(at, [&](const Edge& other) {
                                    return leaders.find(other.facet) == group;
                                }) > 1;
            if (within) continue;
            outline[group] += length;
            if (wall) along_walls[group] += length;
        }
    });
    std::vector<std::vector<FacetId>> of_leader(mesh.facets.size()), openings;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        if (is_interface(FacetId(f))) of_leader[leaders.find(FacetId(f))].push_back(FacetId(f));
    for (std::size_t group = 0; group < of_leader.size(); ++group)
        if (!of_leader[group].empty() && along_walls[group] >= walled * outline[group])
            openings.push_back(std::move(of_leader[group]));
    return openings;
}

}  // namespace tyndall::mesh
