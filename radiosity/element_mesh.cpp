#include "radiosity/element_mesh.h"

#include <algorithm>
#include <queue>

#include "mesh/input_error.h"

namespace tyndall::radiosity {
namespace {

std::vector<std::uint32_t> surface_groups(const Enclosure& enclosure) {
    std::vector<std::uint32_t> groups;
    for (const auto& sides : enclosure.facet_sides)
        groups.insert(groups.end(), {sides[0], sides[1]});
    return groups;
}

// Samples beside a plane step into their element by this share of the way to its centroid.
constexpr double step_aside = 1e-5;
// Planes a vertex can be marked with; it would take many shadows that end in one point.
constexpr std::size_t most_marks = 30;

// The number of the edge between two corners: (0, 1), (0, 2), …
template <int corners>
int edge_of(int i, int j) {
    const auto [low, high] = std::minmax(i, j);
    return low * (2 * corners - low - 1) / 2 + high - low - 1;
}

template <class Known, class Node>
Known& known_of(std::vector<Known>& known, Node node, std::size_t nodes) {
    if (node.value >= known.size()) known.resize(nodes);
    return known[node.value];
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
    bisect(zone, edge, 0.5);
}

void ElementMesh::bisect(ZoneId zone, std::array<int, 2> edge, double t) {
    const ZoneId first = forest_.bisect(zone, edge[0], edge[1], t);
    zones_.push_back(first);
    zones_.push_back(ZoneId(first.value + 1ull));
    ++zone_leaves_;
}

void ElementMesh::bisect(PatchId patch) {
    const std::size_t before = patches_.size();
    surfaces_.refine(forest_, patch, &patches_);
    patch_leaves_ += (patches_.size() - before) / 2;
}

void ElementMesh::bisect(PatchId patch, std::array<int, 2> edge, double t) {
    const std::size_t before = patches_.size();
    surfaces_.split(forest_, patch, edge[0], edge[1], t, &patches_);
    patch_leaves_ += (patches_.size() - before) / 2;
}

void ElementMesh::mark(VertexId vertex, std::uint32_t plane_index, const ShadowPlane& plane) {
    Marks& marks = marks_[vertex.value];
    if (marks.size() >= most_marks) return;
    if (std::find(marks.begin(), marks.end(), plane_index) != marks.end()) return;
    marks.push_back(plane_index);
    if (vertex.value >= mark_counts_.size())
        mark_counts_.resize(std::max<std::size_t>(forest_.vertex_count(), vertex.value + 1ull));
    ++mark_counts_[vertex.value];
    mark_planes_.try_emplace(plane_index, plane);
}

bool ElementMesh::on_one_shadow(std::span<const VertexId> vertices) const {
    const auto marked = [&](VertexId vertex, std::uint32_t mark) {
        const auto marks = marks_.find(vertex.value);
        return marks != marks_.end() &&
               std::find(marks->second.begin(), marks->second.end(), mark) != marks->second.end();
    };
    const auto first = marks_.find(vertices.front().value);
    return first != marks_.end() &&
           std::any_of(first->second.begin(), first->second.end(), [&](std::uint32_t mark) {
               return std::all_of(vertices.begin(), vertices.end(),
                                  [&](VertexId v) { return marked(v, mark); });
           });
}

SampleId ElementMesh::sample(ZoneId zone, VertexId vertex, std::uint32_t sides, Point x) {
    const TetId tet = forest_.base_tet(zone);
    return sides == 0 ? samples_.in_zone(vertex, tet) : samples_.in_zone(vertex, tet, sides, x);
}

SampleId ElementMesh::sample(PatchId patch, VertexId vertex, std::uint32_t sides, Point x) {
    const auto side = forest_.base_facet_side(patch);
    return sides == 0 ? samples_.on_patch(vertex, side) : samples_.on_patch(vertex, side, sides, x);
}

// The sample on the side of the node's centroid: moved towards it until it is on that side of all
// marked planes, which a vertex that is not quite on them may not be.
template <class Node>
SampleId ElementMesh::lit(Node node, VertexId vertex, const Marks& marks) {
    const Point x = forest_.point(vertex);
    if (marks.empty()) return sample(node, vertex, 0, x);
    const Point centroid = forest_.centroid(node);
    std::uint32_t sides = 1;
    double step = step_aside;
    for (const std::uint32_t mark : marks) {
        const ShadowPlane& plane = mark_planes_.at(mark);
        const double there = plane.at(centroid), here = plane.at(x);
        sides = sides << 1 | (there > 0.0);
        if (here * there < 0.0) step = std::max(step, 1.001 * here / (here - there) + step_aside);
    }
    return sample(node, vertex, sides, x + std::min(step, 0.5) * (centroid - x));
}

const ElementMesh::Marks& ElementMesh::marks_at(VertexId vertex) const {
    static const Marks unmarked;
    if (mark_count(vertex) == 0) return unmarked;
    return marks_.find(vertex.value)->second;
}

template <std::size_t corners>
template <class Node>
ElementMesh::LitSamples<corners>& ElementMesh::LitNodes<corners>::of(Node node, std::size_t nodes) {
    std::uint32_t& found = known_of(entry, node, nodes);
    if (found == 0) {
        found = static_cast<std::uint32_t>(samples.size());
        samples.emplace_back();
    }
    return samples[found];
}

template <std::size_t count, class Node>
std::array<SampleId, count> ElementMesh::lit_corners_of(Node node) {
    const auto& vertices = forest_[node].corners;
    std::uint32_t marks = 0;
    for (const VertexId vertex : vertices) marks += mark_count(vertex);
    if (marks == 0) return corners(node);
    LitSamples<count>& known =
        lit_nodes(node).of(node, count == 4 ? forest_.zone_count() : forest_.patch_count());
    if (known.corner_marks != marks) {
        for (std::size_t k = 0; k < count; ++k)
            known.at_corners[k] = lit(node, vertices[k], marks_at(vertices[k]));
        known.corner_marks = marks;
    }
    return known.at_corners;
}

template <std::size_t count, class Node>
SampleId ElementMesh::lit_middle_of(Node node, int i, int j) {
    const auto& vertices = forest_[node].corners;
    const VertexId a = vertices[i], b = vertices[j], middle = middle_vertex<count>(node, i, j);
    const auto marks = [&] { return mark_count(a) + mark_count(b) + mark_count(middle); };
    if (marks() == 0) return middle_of<count>(node, i, j);
    LitSamples<count>& known =
        lit_nodes(node).of(node, count == 4 ? forest_.zone_count() : forest_.patch_count());
    const int edge = edge_of<count>(i, j);
    if (known.middle_marks[edge] == marks()) return known.in_middles[edge];
    // What both ends lie on the middle lies on, too.
    const Marks first = marks_at(a), &second = marks_at(b);
    for (const std::uint32_t m : first)
        if (std::find(second.begin(), second.end(), m) != second.end())
            mark(middle, m, mark_planes_.at(m));
    known.middle_marks[edge] = marks();
    return known.in_middles[edge] = lit(node, middle, marks_at(middle));
}

template std::array<SampleId, 4> ElementMesh::lit_corners_of<4>(ZoneId);
template std::array<SampleId, 3> ElementMesh::lit_corners_of<3>(PatchId);
template SampleId ElementMesh::lit_middle_of<4>(ZoneId, int, int);
template SampleId ElementMesh::lit_middle_of<3>(PatchId, int, int);

template <std::size_t count, class Node>
ElementMesh::NodeSamples<count>& ElementMesh::samples_of(Node node) {
    if constexpr (count == 4)
        return known_of(of_zone_, node, forest_.zone_count());
    else
        return known_of(of_patch_, node, forest_.patch_count());
}

std::array<SampleId, 4> ElementMesh::corners(ZoneId zone) {
    auto& known = samples_of<4>(zone).at_corners;
    if (known[0].valid()) return known;
    const auto vertices = forest_[zone].corners;
    const TetId tet = forest_.base_tet(zone);
    for (int k = 0; k < 4; ++k) known[k] = samples_.in_zone(vertices[k], tet);
    return known;
}

std::array<SampleId, 3> ElementMesh::corners(PatchId patch) {
    auto& known = samples_of<3>(patch).at_corners;
    if (known[0].valid()) return known;
    const auto vertices = forest_[patch].corners;
    const auto side = forest_.base_facet_side(patch);
    for (int k = 0; k < 3; ++k) known[k] = samples_.on_patch(vertices[k], side);
    return known;
}

template <std::size_t count, class Node>
VertexId ElementMesh::middle_vertex(Node node, int i, int j) {
    VertexId& known = samples_of<count>(node).middles[edge_of<count>(i, j)];
    if (!known.valid())
        known = forest_.vertex_on_edge(forest_[node].corners[i], forest_[node].corners[j]);
    return known;
}

template <std::size_t count, class Node>
SampleId ElementMesh::middle_of(Node node, int i, int j) {
    SampleId& known = samples_of<count>(node).in_middles[edge_of<count>(i, j)];
    if (!known.valid()) known = sample(node, middle_vertex<count>(node, i, j), 0, {});
    return known;
}

template SampleId ElementMesh::middle_of<4>(ZoneId, int, int);
template SampleId ElementMesh::middle_of<3>(PatchId, int, int);

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

void ElementMesh::replay(const Forest& saved) {
    const auto& history = saved.history();
    const auto other_mesh = [] {
        return mesh::InputError(
            "the mesh to go on with began as another one. Give the same scene, or begin anew.");
    };
    const auto same = [](const Forest::Bisection& a, const Forest::Bisection& b) {
        return a.node == b.node && a.i == b.i && a.j == b.j && a.t == b.t;
    };
    const auto& own = forest_.history();
    for (std::size_t k = 0; k < std::min(own.size(), history.size()); ++k)
        if (!same(own[k], history[k])) throw other_mesh();
    // Which end of an edge comes first depends on the vertices' numbers: they are made in the order
    // they had.
    for (const auto& [a, b, t] : saved.vertex_edges()) {
        if (std::max(a, b).value >= forest_.vertex_count()) throw other_mesh();
        forest_.vertex_on_edge(a, b, t);
    }
    // A patch takes the one beyond its edge along, as it did before: one step, two bisections.
    while (own.size() < history.size()) {
        const std::size_t k = own.size();
        const Forest::Bisection step = history[k];
        const bool is_patch = step.node & 0x80000000u;
        const std::uint32_t node = step.node & 0x7fffffffu;
        if (node >= (is_patch ? forest_.patch_count() : forest_.zone_count())) throw other_mesh();
        if (is_patch ? !forest_.is_leaf(PatchId(node)) : !forest_.is_leaf(ZoneId(node)))
            throw other_mesh();
        if (is_patch)
            bisect(PatchId(node), {step.i, step.j}, step.t);
        else
            bisect(ZoneId(node), {step.i, step.j}, step.t);
        if (!same(own[k], step)) throw other_mesh();
    }
}

}  // namespace tyndall::radiosity
