#include "radiosity/shadow_cuts.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "radiosity/open_places.h"

namespace tyndall::radiosity {
namespace {

// Of an element's longest edge: penumbrae wider than this are left to bisection in the middle.
constexpr double widest_cut = 0.5;
// Of an element's longest edge: how far on either side of a sharp edge light is looked at.
constexpr double aside = 1e-5;
// What is on the smaller side of a penumbra's sheet may be little; the bend there is still felt
// in the whole element.
constexpr double least_spread = 0.1;
// Sheets at one element whose jumps are measured, the largest sections first.
constexpr std::size_t most_measured = 12;

template <std::size_t count>
std::array<Point, count> points_of(const Forest& forest,
                                   const std::array<VertexId, count>& corners) {
    std::array<Point, count> points;
    for (std::size_t k = 0; k < count; ++k) points[k] = forest.point(corners[k]);
    return points;
}

// Share of a simplex in which the linear function with these values at its corners is negative:
// Σ_{d_i < 0} d_i^n / Π_{j ≠ i} (d_i − d_j), n its dimension.
template <std::size_t count>
double share_below(std::array<double, count> d) {
    double reach = 0.0;
    for (const double v : d) reach = std::max(reach, std::abs(v));
    // The formula wants values apart.
    for (std::size_t k = 0; k < count; ++k) d[k] += 1e-3 * reach * static_cast<double>(k);
    double sum = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        if (d[i] >= 0.0) continue;
        double term = 1.0;
        for (std::size_t j = 0; j < count; ++j)
            if (j != i) term *= d[i] / (d[i] - d[j]);
        sum += term;
    }
    return std::clamp(sum, 0.0, 1.0);
}

// The barycentric coordinates' numerators of x.
std::array<double, 4> weights(const std::array<Point, 4>& p, Point x) {
    const auto volume = [](Point a, Point b, Point c, Point d) {
        return glm::dot(glm::cross(b - a, c - a), d - a);
    };
    return {volume(x, p[1], p[2], p[3]), volume(p[0], x, p[2], p[3]), volume(p[0], p[1], x, p[3]),
            volume(p[0], p[1], p[2], x)};
}

std::array<double, 3> weights(const std::array<Point, 3>& p, Point x) {
    const auto n = glm::cross(p[1] - p[0], p[2] - p[0]);
    const auto area = [&](Point a, Point b, Point c) {
        return glm::dot(n, glm::cross(b - a, c - a));
    };
    return {area(x, p[1], p[2]), area(p[0], x, p[2]), area(p[0], p[1], x)};
}

// As far along `step` from x, inside, as the element goes.
template <std::size_t count>
Point stay_inside(const std::array<Point, count>& corners, Point x, Direction step) {
    const auto from = weights(corners, x), to = weights(corners, x + step);
    double t = 1.0;
    for (std::size_t k = 0; k < count; ++k)
        if (to[k] < 0.0 && from[k] > to[k])
            t = std::min(t, std::max(0.0, from[k] / (from[k] - to[k])));
    return x + t * step;
}

// A plane's normal, in the plane of a patch.
Direction across(const Forest&, ZoneId, const ShadowPlane& plane) {
    return plane.normal;
}
Direction across(const Forest& forest, PatchId patch, const ShadowPlane& plane) {
    const Direction n = normal_of(forest, patch);
    return plane.normal - glm::dot(plane.normal, n) * n;
}

}  // namespace

ShadowCuts::ShadowCuts(const Enclosure& enclosure, const ShadowBoundaries& boundaries,
                       ElementMesh& mesh, const DirectLight& light)
    : enclosure_(enclosure), boundaries_(boundaries), mesh_(mesh), light_(light) {}

// Sheets at a node are among those at the nearest node above that has been looked at, or those at
// the base tet.
template <class Node>
void ShadowCuts::find_sheets(Node node, std::vector<Known>& known) const {
    const Forest& forest = mesh_.forest();
    const auto corners = points_of(forest, forest[node].corners);
    const auto& sheets = boundaries_.sheets();
    std::vector<std::uint32_t> found;
    const auto test = [&](std::uint32_t k) {
        if (boundaries_.section(sheets[k], corners)) found.push_back(k);
    };
    Node above = forest[node].parent;
    while (above.valid() && !known[above.value].looked_at) above = forest[above].parent;
    if (above.valid())
        for (const std::uint32_t k : known[above.value].sheets) test(k);
    else
        for (const std::uint32_t k : boundaries_.at(tet_of(node))) test(k);
    known[node.value].sheets = std::move(found);
    known[node.value].looked_at = true;
}

// Corners on a sharp sheet, or where a penumbra's sheets meet, have a value on either side.
template <class Node>
void ShadowCuts::mark_corners(Node node, const std::vector<std::uint32_t>& sheets) {
    const Forest& forest = mesh_.forest();
    const auto& vertices = forest[node].corners;
    const auto corners = points_of(forest, vertices);
    for (const std::uint32_t k : sheets) {
        const ShadowSheet& sheet = boundaries_.sheets()[k];
        double reach = 0.0;
        for (const Point& x : corners) reach = std::max(reach, std::abs(sheet.plane.at(x)));
        for (std::size_t c = 0; c < corners.size(); ++c) {
            const double near = boundaries_.snap(sheet, corners[c], reach);
            if (std::abs(sheet.plane.at(corners[c])) > near) continue;
            if (boundaries_.width(sheet, corners[c]) > near) continue;
            if (boundaries_.section(sheet, {&corners[c], 1}, reach))
                mesh_.mark(vertices[c], sheet.plane_index, sheet.plane);
        }
    }
}

TetId ShadowCuts::tet_of(ZoneId zone) const {
    return mesh_.forest().base_tet(zone);
}

TetId ShadowCuts::tet_of(PatchId patch) const {
    return mesh::tet_before(enclosure_.mesh, mesh_.forest().base_facet_side(patch),
                            mesh_.forest().centroid(patch));
}

void ShadowCuts::incident(ZoneId zone, Point x, std::vector<double>& value) const {
    const OpenPlace place = open_place(enclosure_, x, tet_of(zone));
    light_.at_zone(place.x, place.tet, value);
}

void ShadowCuts::incident(PatchId patch, Point x, std::vector<double>& value) const {
    light_.at_patch(x, normal_of(mesh_.forest(), patch), tet_of(patch), value);
}

// Root of the mean square of what direct light changes by across a sheet.
template <class Node>
double ShadowCuts::jump(Node node, const ShadowSheet& sheet, const ShadowSection& section) const {
    const Forest& forest = mesh_.forest();
    const auto corners = points_of(forest, forest[node].corners);
    const Direction normal = across(forest, node, sheet.plane);
    const double square = glm::dot(normal, normal);
    if (!(square > 1e-12)) return 0.0;
    Point middle(0.0);
    for (int k = 0; k < section.count; ++k) middle += section.points[k] / double(section.count);
    thread_local std::vector<double> one, other;
    one.resize(enclosure_.bands);
    other.resize(enclosure_.bands);
    double sum = 0.0;
    for (int k = -1; k < section.count; ++k) {
        const Point x = k < 0 ? middle : middle + 0.6 * (section.points[k] - middle);
        Direction step = (aside * forest[node].longest_edge / std::sqrt(square)) * normal;
        Point from = stay_inside(corners, x, -step);
        if (sheet.partner != none) {
            const ShadowPlane& partner = boundaries_.sheets()[sheet.partner].plane;
            const double slope = glm::dot(partner.normal, normal);
            if (std::abs(slope) < 0.1 * square) continue;
            step = (-partner.at(x) / slope) * normal;
            from = x;
        }
        incident(node, from, one);
        incident(node, stay_inside(corners, x, step), other);
        double difference = 0.0;
        for (std::size_t b = 0; b < one.size(); ++b) difference += std::abs(one[b] - other[b]);
        difference /= static_cast<double>(one.size());
        sum += difference * difference;
    }
    return std::sqrt(sum / (section.count + 1));
}

template <class Node>
ShadowCuts::Cut ShadowCuts::measure(Node node, const std::vector<std::uint32_t>& sheets) const {
    const Forest& forest = mesh_.forest();
    const auto corners = points_of(forest, forest[node].corners);
    constexpr bool is_zone = std::is_same_v<Node, ZoneId>;
    struct Crossing {
        double share;
        std::uint32_t sheet;
        ShadowSection section;
    };
    std::vector<Crossing> crossings;
    for (const std::uint32_t k : sheets) {
        const ShadowSheet& sheet = boundaries_.sheets()[k];
        const ShadowSection section = boundaries_.section(sheet, corners);
        if (!section.crosses) continue;
        Point middle(0.0);
        for (int c = 0; c < section.count; ++c) middle += section.points[c] / double(section.count);
        if (boundaries_.width(sheet, middle) > widest_cut * forest[node].longest_edge) continue;
        crossings.push_back({section.share, k, section});
    }
    std::stable_sort(crossings.begin(), crossings.end(),
                     [](const Crossing& a, const Crossing& b) { return a.share > b.share; });
    if (crossings.size() > most_measured) crossings.resize(most_measured);
    Cut worst;
    for (const Crossing& crossing : crossings) {
        const ShadowSheet& sheet = boundaries_.sheets()[crossing.sheet];
        auto distance = std::array<double, std::tuple_size_v<decltype(corners)>>{};
        for (std::size_t c = 0; c < corners.size(); ++c) distance[c] = sheet.plane.at(corners[c]);
        const double below = share_below(distance);
        double spread = below * (1.0 - below);
        if (sheet.partner != none) spread = std::max(spread, least_spread);
        const double error = (is_zone ? chord_share : 1.0) * std::sqrt(spread * crossing.share) *
                             jump(node, sheet, crossing.section);
        if (error > worst.error) worst = {static_cast<float>(error), crossing.sheet};
    }
    return worst;
}

template <class Node>
void ShadowCuts::look(const std::vector<Node>& nodes, std::vector<Known>& known) {
    tbb::parallel_for(std::size_t(0), nodes.size(),
                      [&](std::size_t k) { find_sheets(nodes[k], known); });
    for (const Node node : nodes) mark_corners(node, known[node.value].sheets);
    tbb::parallel_for(std::size_t(0), nodes.size(), [&](std::size_t k) {
        Known& node = known[nodes[k].value];
        node.cut = measure(nodes[k], node.sheets);
    });
}

void ShadowCuts::update(const std::vector<ZoneId>& zones, const std::vector<PatchId>& patches) {
    zones_.resize(mesh_.forest().zone_count());
    patches_.resize(mesh_.forest().patch_count());
    look(zones, zones_);
    look(patches, patches_);
}

std::size_t ShadowCuts::memory() const {
    std::size_t sum = 0;
    for (const auto* known : {&zones_, &patches_}) {
        sum += known->capacity() * sizeof(Known);
        for (const Known& node : *known) sum += node.sheets.capacity() * sizeof(std::uint32_t);
    }
    return sum;
}

// Bisects where the plane crosses the longest edge that it crosses, and so on below.
template <class Node>
void ShadowCuts::cut_along(Node node, const ShadowSheet& sheet, double reach,
                           std::size_t max_leaves) {
    const Forest& forest = mesh_.forest();
    if (forest.is_leaf(node)) {
        if (mesh_.leaf_count() >= max_leaves) return;
        const auto vertices = forest[node].corners;
        const auto corners = points_of(forest, vertices);
        if (!boundaries_.section(sheet, corners, reach).crosses) return;
        std::array<int, 2> edge{-1, -1};
        double longest = 0.0;
        const int count = static_cast<int>(corners.size());
        for (int i = 0; i < count; ++i)
            for (int j = 0; j < count; ++j) {
                if (sheet.plane.at(corners[i]) >= -boundaries_.snap(sheet, corners[i], reach) ||
                    sheet.plane.at(corners[j]) <= boundaries_.snap(sheet, corners[j], reach))
                    continue;
                const double length = glm::distance(corners[i], corners[j]);
                if (length <= longest) continue;
                longest = length;
                edge = {i, j};
            }
        if (edge[0] < 0) return;
        // From the lower vertex always, so that all around the edge agree to the last bit.
        if (vertices[edge[1]] < vertices[edge[0]]) std::swap(edge[0], edge[1]);
        const double a = sheet.plane.at(corners[edge[0]]), b = sheet.plane.at(corners[edge[1]]);
        mesh_.bisect(node, edge, a / (a - b));
        if (forest.is_leaf(node)) return;  // no surface mesh holds it
    }
    const Node first = forest[node].first_child;
    cut_along(first, sheet, reach, max_leaves);
    cut_along(Node(first.value + 1ull), sheet, reach, max_leaves);
}

template <class Node>
bool ShadowCuts::cut_leaf(Node node, const Cut& cut, std::size_t max_leaves) {
    if (cut.sheet == none) return false;
    const std::size_t before = mesh_.leaf_count();
    const auto corners = points_of(mesh_.forest(), mesh_.forest()[node].corners);
    for (std::uint32_t k = cut.sheet; k != none;) {
        const ShadowSheet& sheet = boundaries_.sheets()[k];
        double reach = 0.0;
        for (const Point& x : corners) reach = std::max(reach, std::abs(sheet.plane.at(x)));
        cut_along(node, sheet, reach, max_leaves);
        k = k == cut.sheet ? sheet.partner : none;
    }
    return mesh_.leaf_count() > before;
}

bool ShadowCuts::cut(ZoneId zone, std::size_t max_leaves) {
    return cut_leaf(zone, zones_[zone.value].cut, max_leaves);
}

bool ShadowCuts::cut(PatchId patch, std::size_t max_leaves) {
    return cut_leaf(patch, patches_[patch.value].cut, max_leaves);
}

}  // namespace tyndall::radiosity
