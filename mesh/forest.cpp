#include "mesh/forest.h"

#include <bit>
#include <cassert>
#include <glm/geometric.hpp>

namespace tyndall::mesh {
namespace {

Carrier join(const Carrier& a, const Carrier& b) {
    Carrier result;
    std::size_t n = 0, i = 0, j = 0;
    while (n < 4 && ((i < 4 && a[i].valid()) || (j < 4 && b[j].valid()))) {
        const bool take_a = i < 4 && a[i].valid() && (j >= 4 || !b[j].valid() || a[i] <= b[j]);
        const VertexId v = take_a ? a[i] : b[j];
        if (i < 4 && a[i] == v) ++i;
        if (j < 4 && b[j] == v) ++j;
        result[n++] = v;
    }
    return result;
}

template <std::size_t N, class GetPoint>
std::array<int, 2> longest_edge_of(const std::array<VertexId, N>& corners, GetPoint&& point) {
    std::array<int, 2> best{0, 1};
    double best_length = -1.0;
    std::array<VertexId, 2> best_ids;
    for (int i = 0; i < static_cast<int>(N); ++i)
        for (int j = i + 1; j < static_cast<int>(N); ++j) {
            const auto d = point(corners[j]) - point(corners[i]);
            const double length = glm::dot(d, d);
            const std::array<VertexId, 2> ids{std::min(corners[i], corners[j]),
                                              std::max(corners[i], corners[j])};
            if (length > best_length || (length == best_length && ids < best_ids)) {
                best_length = length;
                best = {i, j};
                best_ids = ids;
            }
        }
    return best;
}

}  // namespace

std::size_t Forest::EdgeHash::operator()(const EdgeKey& key) const noexcept {
    std::uint64_t h = (std::uint64_t(key.a.value) << 32 | key.b.value) * 0x9e3779b97f4a7c15ull;
    h ^= std::bit_cast<std::uint64_t>(key.t);
    h ^= h >> 29;
    return h * 0xbf58476d1ce4e5b9ull;
}

Forest::Forest(const BaseMesh& base) : points_(base.points) {
    carriers_.resize(points_.size());
    for (std::size_t v = 0; v < points_.size(); ++v) carriers_[v][0] = VertexId(v);
    for (std::size_t t = 0; t < base.tets.size(); ++t) {
        ZoneNode node;
        node.corners = base.tets[t];
        node.longest_edge = edge_bound(node.corners.data(), 4);
        zones_.push_back(node);
        zone_roots_.push_back(static_cast<std::uint32_t>(t));
    }
    for (std::size_t f = 0; f < base.facets.size(); ++f) {
        PatchNode node;
        node.corners = base.facets[f].corners;
        node.longest_edge = edge_bound(node.corners.data(), 3);
        patches_.push_back(node);
        std::swap(node.corners[1], node.corners[2]);
        patches_.push_back(node);
        patch_roots_.push_back(static_cast<std::uint32_t>(2 * f));
        patch_roots_.push_back(static_cast<std::uint32_t>(2 * f + 1));
    }
}

float Forest::edge_bound(const VertexId* corners, int count) const {
    double longest = 0.0;
    for (int i = 0; i < count; ++i)
        for (int j = i + 1; j < count; ++j)
            longest = std::max(longest, glm::distance(point(corners[i]), point(corners[j])));
    return static_cast<float>(longest);
}

VertexId Forest::vertex_on_edge(VertexId a, VertexId b, double t) {
    t = place(t);
    if (b < a) {
        std::swap(a, b);
        t = 1.0 - t;
    }
    const auto [entry, made] = edge_vertices_.try_emplace({a, b, t}, VertexId(points_.size()));
    if (made) {
        points_.push_back(point(a) + t * (point(b) - point(a)));
        carriers_.push_back(join(carrier(a), carrier(b)));
        vertex_edges_.push_back({a, b, t});
    }
    return entry->second;
}

template <class Node>
std::uint32_t Forest::split(std::vector<Node>& nodes, std::vector<std::uint32_t>& roots,
                            std::uint32_t index, int i, int j, double t, Direction normal) {
    Node parent = nodes[index];
    assert(!parent.first_child.valid());
    const VertexId a = parent.corners[i], b = parent.corners[j];
    const VertexId middle = vertex_on_edge(a, b, t);
    normal = glm::normalize(normal);
    if (glm::dot(normal, point(b) - point(a)) < 0.0) normal = -normal;
    const auto first = static_cast<std::uint32_t>(nodes.size());
    using NodeIndex = decltype(parent.first_child);
    nodes[index].plane_normal = normal;
    nodes[index].plane_offset = -glm::dot(normal, point(middle));
    nodes[index].first_child = NodeIndex(first);

    for (const int replaced : {j, i}) {
        Node child;
        child.corners = parent.corners;
        child.corners[replaced] = middle;
        child.parent = NodeIndex(index);
        child.level = parent.level + 1;
        child.longest_edge =
            edge_bound(child.corners.data(), static_cast<int>(child.corners.size()));
        nodes.push_back(child);
        roots.push_back(roots[index]);
    }
    return first;
}

ZoneId Forest::bisect(ZoneId zone, int i, int j, double t) {
    const auto& corners = zones_[zone.value].corners;
    std::array<Point, 2> others;
    for (int k = 0, n = 0; k < 4; ++k)
        if (k != i && k != j) others[n++] = point(corners[k]);
    t = place(t);
    const Point a = point(corners[i]), b = point(corners[j]);
    const Point middle = a + t * (b - a);
    history_.push_back({zone.value, std::uint8_t(i), std::uint8_t(j), t});
    return ZoneId(split(zones_, zone_roots_, zone.value, i, j, t,
                        glm::cross(others[0] - middle, others[1] - middle)));
}

PatchId Forest::bisect(PatchId patch, int i, int j, double t) {
    const auto& c = patches_[patch.value].corners;
    t = place(t);
    const Point a = point(c[i]), b = point(c[j]), apex = point(c[3 - i - j]);
    const auto face = glm::cross(point(c[1]) - point(c[0]), point(c[2]) - point(c[0]));
    const Point middle = a + t * (b - a);
    history_.push_back({patch.value | 0x80000000u, std::uint8_t(i), std::uint8_t(j), t});
    return PatchId(
        split(patches_, patch_roots_, patch.value, i, j, t, glm::cross(face, apex - middle)));
}

void Forest::replay(const std::vector<Bisection>& history) {
    for (const auto& step : history) {
        if (step.node & 0x80000000u)
            bisect(PatchId(step.node & 0x7fffffffu), step.i, step.j, step.t);
        else
            bisect(ZoneId(step.node), step.i, step.j, step.t);
    }
}

Point Forest::centroid(ZoneId id) const {
    const auto& c = (*this)[id].corners;
    return 0.25 * (point(c[0]) + point(c[1]) + point(c[2]) + point(c[3]));
}

Point Forest::centroid(PatchId id) const {
    const auto& c = (*this)[id].corners;
    return (point(c[0]) + point(c[1]) + point(c[2])) / 3.0;
}

double Forest::volume(ZoneId id) const {
    const auto& c = (*this)[id].corners;
    const Point a = point(c[0]);
    return glm::dot(glm::cross(point(c[1]) - a, point(c[2]) - a), point(c[3]) - a) / 6.0;
}

double Forest::area(PatchId id) const {
    const auto& c = (*this)[id].corners;
    const Point a = point(c[0]);
    return 0.5 * glm::length(glm::cross(point(c[1]) - a, point(c[2]) - a));
}

std::array<int, 2> Forest::longest_edge(ZoneId id) const {
    return longest_edge_of((*this)[id].corners, [this](VertexId v) { return point(v); });
}

std::array<int, 2> Forest::longest_edge(PatchId id) const {
    return longest_edge_of((*this)[id].corners, [this](VertexId v) { return point(v); });
}

PatchId Forest::leaf_at(PatchId patch, Point x) const {
    while (!is_leaf(patch)) {
        const PatchNode& node = (*this)[patch];
        const bool second = glm::dot(node.plane_normal, x) + node.plane_offset > 0.0;
        patch = PatchId(std::uint64_t(node.first_child.value) + second);
    }
    return patch;
}

ZoneId Forest::leaf_at(ZoneId zone, Point x) const {
    while (!is_leaf(zone)) {
        const ZoneNode& node = (*this)[zone];
        const bool second = glm::dot(node.plane_normal, x) + node.plane_offset > 0.0;
        zone = ZoneId(std::uint64_t(node.first_child.value) + second);
    }
    return zone;
}

std::size_t Forest::memory() const {
    return points_.capacity() * (sizeof(Point) + sizeof(Carrier)) +
           zones_.capacity() * (sizeof(ZoneNode) + 4) +
           patches_.capacity() * (sizeof(PatchNode) + 4) +
           edge_vertices_.size() * (48 + sizeof(VertexEdge)) +
           history_.capacity() * sizeof(Bisection);
}

}  // namespace tyndall::mesh
