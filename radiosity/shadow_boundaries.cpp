#include "radiosity/shadow_boundaries.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

#include "mesh/walk.h"
#include "radiosity/indicators.h"
#include "radiosity/light_sources.h"

namespace tyndall::radiosity {
namespace {

// Of the mesh's diagonal: points nearer to a plane are on it.
constexpr double on_plane = 1e-10;
// Of an element's reach from a sharp plane: corners nearer count as on it, or slivers come up.
constexpr double snapped = 0.003;
// Of a penumbra's width: H is continuous there, and what is snapped shows as that much of its rise.
constexpr double snapped_in_penumbra = 0.002;
// Seen from an edge, lights narrower than this have no extent, wider ones no sharp shadow [rad].
constexpr double narrow_light = 1e-7, wide_light = 0.5;
// Pairs of sheets and base tets beyond which no more sheets are followed.
constexpr std::size_t most_sheet_pairs = 50'000'000;

}  // namespace

// A light's points; directions towards it if it is infinitely far.
struct ShadowBoundaries::Source {
    std::vector<Point> points;
    bool infinite = false;
    std::vector<ShadowPlane> fronts;  // an edge must be in front of one of these; empty: no matter

    Direction from(Point x, Point light) const { return infinite ? light : light - x; }
    bool shines_at(Point x, double tolerance) const {
        return fronts.empty() || std::any_of(fronts.begin(), fronts.end(),
                                             [&](const auto& f) { return f.at(x) > tolerance; });
    }
};

struct ShadowBoundaries::Edge {
    std::array<mesh::VertexId, 2> ends;
    Point a, b;
    std::vector<Point> apexes;  // the third corners of the opaque facets on it
};

std::vector<ShadowBoundaries::Source> ShadowBoundaries::sources(const Enclosure& enclosure,
                                                                bool emitters) const {
    std::vector<Source> result;
    for (const Light& light : enclosure.lights) {
        if (const auto* sun = std::get_if<Sun>(&light.source)) {
            if (sun->angle > 0.0)
                result.push_back({sun_disc(*sun), true, {}});
            else
                result.push_back({{-glm::normalize(sun->direction)}, true, {}});
        } else if (const auto* point = std::get_if<PointLight>(&light.source)) {
            result.push_back({{point->position}, false, {}});
        } else if (const auto* spot = std::get_if<SpotLight>(&light.source)) {
            result.push_back({{spot->position}, false, {}});
        }
    }
    if (!emitters) return result;
    std::map<std::uint32_t, Source> sides;
    for (std::size_t f = 0; f < enclosure.facet_sides.size(); ++f)
        for (int k = 0; k < 2; ++k) {
            const auto side = enclosure.facet_sides[f][k];
            if (side == none) continue;
            if (!shines(enclosure.sides[side])) continue;
            Direction n = mesh::normal(enclosure.mesh, FacetId(f));
            if (k == 1) n = -n;
            Source& source = sides[side];
            for (const auto corner : enclosure.mesh.facets[f].corners)
                source.points.push_back(enclosure.mesh.points[corner.value]);
            source.fronts.push_back({n, -glm::dot(n, source.points.back())});
        }
    for (auto& [side, source] : sides) result.push_back(std::move(source));
    return result;
}

ShadowBoundaries::ShadowBoundaries(const Enclosure& enclosure, bool emitters)
    : tolerance_(on_plane * glm::distance(enclosure.mesh.hull_min, enclosure.mesh.hull_max)) {
    // An odd point, which few planes of one scene are at one distance from.
    origin_ = enclosure.mesh.hull_min +
              Point(0.3717, 0.6143, 0.2311) * (enclosure.mesh.hull_max - enclosure.mesh.hull_min);
    const auto& mesh = enclosure.mesh;
    std::map<std::pair<mesh::VertexId, mesh::VertexId>, std::vector<Point>> edges;
    const auto active = [&](TetId tet) { return tet.valid() && !enclosure.solid(tet); };
    for (const auto& facet : mesh.facets) {
        if (facet.opacity != mesh::Opacity::opaque) continue;
        if (!active(facet.tets[0]) && !active(facet.tets[1])) continue;
        for (int k = 0; k < 3; ++k) {
            const auto a = facet.corners[k], b = facet.corners[(k + 1) % 3];
            edges[std::minmax(a, b)].push_back(mesh.points[facet.corners[(k + 2) % 3].value]);
        }
    }
    for (const Source& source : sources(enclosure, emitters))
        for (const auto& [ends, apexes] : edges)
            add_sheets({{ends.first, ends.second},
                        mesh.points[ends.first.value],
                        mesh.points[ends.second.value],
                        apexes},
                       source);
    spread(mesh);
}

namespace {

// A body's edge is no tet's: the tets that it passes through.
template <class Try>
void try_tets_along(const mesh::BaseMesh& mesh, mesh::VertexId a, mesh::VertexId b,
                    const Try& try_tet) {
    const Point from = mesh.points[a.value];
    const Direction way = mesh.points[b.value] - from;
    const TetId start = mesh::locate(mesh, from);
    if (!start.valid()) return;
    try_tet(start.value);
    mesh::walk<mesh::Passes::everything>(mesh, {from, glm::normalize(way), glm::length(way)},
                                         {start}, [&](TetId tet, double, double) {
                                             try_tet(tet.value);
                                             return true;
                                         });
}

}  // namespace

// From the tets around a sheet's edge on from tet to tet, up to what is opaque.
void ShadowBoundaries::spread(const mesh::BaseMesh& mesh) {
    std::vector<std::vector<std::uint32_t>> at_vertex(mesh.points.size()), found(mesh.tets.size());
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
        for (const auto corner : mesh.tets[t])
            at_vertex[corner.value].push_back(static_cast<std::uint32_t>(t));
    std::size_t pairs = 0;
    std::vector<std::uint32_t> reached;
    std::vector<std::uint32_t> seen(mesh.tets.size(), none);  // by the sheet of that index
    for (std::uint32_t k = 0; k < sheets_.size() && pairs < most_sheet_pairs; ++k) {
        const auto try_tet = [&](std::uint32_t t) {
            if (seen[t] == k) return;
            seen[t] = k;
            std::array<Point, 4> corners;
            for (int c = 0; c < 4; ++c) corners[c] = mesh.points[mesh.tets[t][c].value];
            if (section(sheets_[k], corners)) reached.push_back(t);
        };
        reached.clear();
        const auto [a, b] = sheets_[k].edge;
        for (const std::uint32_t t : at_vertex[a.value])
            if (std::find(mesh.tets[t].begin(), mesh.tets[t].end(), b) != mesh.tets[t].end())
                try_tet(t);
        if (at_vertex[a.value].empty()) try_tets_along(mesh, a, b, try_tet);
        for (std::size_t n = 0; n < reached.size(); ++n) {
            const std::uint32_t t = reached[n];
            for (int face = 0; face < 4; ++face) {
                const auto facet = mesh.tet_facets[t][face];
                if (facet.valid() && mesh.facets[facet.value].opacity == mesh::Opacity::opaque)
                    continue;
                if (const TetId next = mesh.neighbours[t][face]; next.valid()) try_tet(next.value);
            }
        }
        for (const std::uint32_t t : reached) found[t].push_back(k);
        pairs += reached.size();
    }
    begin_.push_back(0);
    for (const auto& list : found) {
        touching_.insert(touching_.end(), list.begin(), list.end());
        begin_.push_back(touching_.size());
    }
}

// Equal planes get one index, so that an element is cut along them once.
std::uint32_t ShadowBoundaries::index_of(ShadowPlane& plane) {
    const double distance = std::abs(plane.at(origin_));
    for (auto near = plane_order_.lower_bound(distance - tolerance_);
         near != plane_order_.end() && near->first <= distance + tolerance_; ++near) {
        const ShadowPlane& other = planes_[near->second];
        const double cosine = glm::dot(plane.normal, other.normal);
        const double side = std::copysign(1.0, cosine);
        if (std::abs(cosine) < 1.0 - 1e-14) continue;
        if (std::abs(plane.offset - side * other.offset) > tolerance_) continue;
        plane = other;
        return near->second;
    }
    const auto index = static_cast<std::uint32_t>(planes_.size());
    planes_.push_back(plane);
    plane_order_.emplace(distance, index);
    return index;
}

// Where a light is as seen from an edge: angles around it, from the middle of the light.
struct ShadowBoundaries::Fan {
    Direction along{0.0}, u{0.0}, v{0.0};
    Point start{0.0};  // on the edge
    double low = 1e300, high = -1e300;

    Fan(const Edge& edge, const Source& source)
        : along((edge.b - edge.a) / glm::distance(edge.a, edge.b)), start(edge.a) {
        for (const Point& light : source.points) u += across(source, light);
        if (glm::dot(u, u) > 0.0) u = glm::normalize(u);
        v = glm::cross(along, u);
        for (const Point& light : source.points) {
            low = std::min(low, angle(source, light));
            high = std::max(high, angle(source, light));
        }
    }
    // Towards a point of the light, square to the edge.
    Direction across(const Source& source, Point light) const {
        const Direction d = source.from(start, light);
        return d - glm::dot(d, along) * along;
    }
    double angle(const Source& source, Point light) const {
        const Direction d = across(source, light);
        return std::atan2(glm::dot(v, d), glm::dot(u, d));
    }
    Direction to_light(double angle) const { return std::cos(angle) * u + std::sin(angle) * v; }
};

// The sheet at an angle of the fan: its plane, and the rays through its ends, the widest of those
// from the points of the light that the plane touches.
ShadowSheet ShadowBoundaries::sheet_at(double angle, const Fan& fan, const Edge& edge,
                                       const Source& source) const {
    ShadowSheet sheet;
    sheet.edge = edge.ends;
    const Direction to_light = fan.to_light(angle);
    sheet.plane.normal = glm::cross(fan.along, to_light);
    sheet.plane.offset = -glm::dot(sheet.plane.normal, edge.a);
    sheet.bounds[0] = {-to_light, -glm::dot(to_light, edge.a)};
    for (int end = 0; end < 2; ++end) {
        const Point corner = end == 0 ? edge.a : edge.b;
        const Direction inward = end == 0 ? fan.along : -fan.along;
        double widest = 1e300;
        for (const Point& light : source.points) {
            if (std::abs(fan.angle(source, light) - angle) > narrow_light) continue;
            const Direction ray = -glm::normalize(source.from(corner, light));
            const double lean = glm::dot(ray, inward);
            if (lean >= widest) continue;
            widest = lean;
            Direction normal = inward - lean * ray;  // square to the ray in the plane
            normal -= glm::dot(normal, sheet.plane.normal) * sheet.plane.normal;
            normal = glm::normalize(normal);
            sheet.bounds[1 + end] = {normal, glm::dot(normal, corner)};
        }
    }
    return sheet;
}

void ShadowBoundaries::add_sheets(const Edge& edge, const Source& source) {
    if (!source.shines_at(edge.a, tolerance_) && !source.shines_at(edge.b, tolerance_)) return;
    const Fan fan(edge, source);
    for (const Point& light : source.points)  // the edge points to the light, or bounds it
        if (!(glm::length(fan.across(source, light)) > tolerance_)) return;
    if (!(fan.high - fan.low < wide_light)) return;
    const bool sharp = fan.high - fan.low < narrow_light;
    std::vector<ShadowSheet> made;
    for (const double angle :
         sharp ? std::vector{0.5 * (fan.low + fan.high)} : std::vector{fan.low, fan.high}) {
        const ShadowSheet sheet = sheet_at(angle, fan, edge, source);
        // A silhouette: something opaque on the one side, nothing on the other. A penumbra is one
        // from both its ends.
        bool front = false, back = false;
        for (const Point& apex : edge.apexes) {
            front |= sheet.plane.at(apex) > tolerance_;
            back |= sheet.plane.at(apex) < -tolerance_;
        }
        if (front == back) return;
        made.push_back(sheet);
    }
    const auto first = static_cast<std::uint32_t>(sheets_.size());
    for (std::uint32_t k = 0; k < made.size(); ++k) {
        made[k].plane_index = index_of(made[k].plane);
        if (!sharp) made[k].partner = first + 1 - k;
        sheets_.push_back(made[k]);
    }
}

double ShadowBoundaries::width(const ShadowSheet& sheet, Point x) const {
    return sheet.partner == none ? 0.0 : std::abs(sheets_[sheet.partner].plane.at(x));
}

double ShadowBoundaries::snap(const ShadowSheet& sheet, Point x, double reach) const {
    const double sharp = snapped * reach;
    if (sheet.partner == none) return std::max(tolerance_, sharp);
    return std::max(tolerance_, std::min(sharp, snapped_in_penumbra * width(sheet, x)));
}

namespace {

double size_of(const ShadowSection& s) {
    if (s.count == 2) return glm::distance(s.points[0], s.points[1]);
    Direction area(0.0);
    for (int k = 2; k < s.count; ++k)
        area += glm::cross(s.points[k - 1] - s.points[0], s.points[k] - s.points[0]);
    return 0.5 * glm::length(area);
}

void clip(ShadowSection& s, const mesh::HalfSpace& bound, double tolerance) {
    ShadowSection kept = s;
    kept.count = 0;
    const auto add = [&](Point p) {
        if (kept.count < static_cast<int>(kept.points.size())) kept.points[kept.count++] = p;
    };
    for (int k = 0; k < s.count; ++k) {
        const Point p = s.points[k], q = s.points[(k + 1) % s.count];
        const double at_p = glm::dot(bound.normal, p) - bound.offset + tolerance;
        const double at_q = glm::dot(bound.normal, q) - bound.offset + tolerance;
        if (at_p >= 0.0) add(p);
        // A segment is gone along once, not there and back.
        if (s.count == 2 && k == 1) continue;
        if ((at_p > 0.0 && at_q < 0.0) || (at_p < 0.0 && at_q > 0.0))
            add(p + at_p / (at_p - at_q) * (q - p));
    }
    s = kept;
}

}  // namespace

ShadowSection ShadowBoundaries::section(const ShadowSheet& sheet, std::span<const Point> corners,
                                        double reach) const {
    ShadowSection s;
    const int count = static_cast<int>(corners.size());
    std::array<double, 4> d{};
    double low = 1e300, high = -1e300;
    for (int k = 0; k < count; ++k) {
        d[k] = sheet.plane.at(corners[k]);
        low = std::min(low, d[k]);
        high = std::max(high, d[k]);
    }
    if (reach == 0.0) reach = std::max(high, -low);
    const double near = std::max(tolerance_, snapped * reach);
    if (low > near || high < -near) return s;
    bool below = false, above = false;
    std::array<int, 4> side{};
    for (int k = 0; k < count; ++k) {
        const double on = snap(sheet, corners[k], reach);
        side[k] = d[k] > on ? 1 : d[k] < -on ? -1 : 0;
        below |= side[k] < 0;
        above |= side[k] > 0;
        if (side[k] == 0) s.points[s.count++] = corners[k];
    }
    s.crosses = below && above;
    std::array<int, 4> order{0, 1, 2, 3};
    std::stable_sort(order.begin(), order.begin() + count,
                     [&](int i, int j) { return side[i] < side[j]; });
    const auto add = [&](int i, int j) {
        if (side[i] * side[j] < 0)
            s.points[s.count++] = corners[i] + d[i] / (d[i] - d[j]) * (corners[j] - corners[i]);
    };
    if (s.count == 0 && count == 4 && side[order[1]] < 0 && side[order[2]] > 0) {
        add(order[0], order[2]), add(order[0], order[3]);
        add(order[1], order[3]), add(order[1], order[2]);
    } else {
        for (int i = 0; i < count; ++i)
            for (int j = i + 1; j < count; ++j) add(order[i], order[j]);
    }
    const double whole = size_of(s);
    for (const auto& bound : sheet.bounds) {
        if (s.count == 0) return s;
        clip(s, bound, 10.0 * tolerance_);
    }
    s.share = whole > 0.0 ? size_of(s) / whole : 0.0;
    // The polygon touches with an edge or corner alone.
    if (s.count < count - 1 || !(s.share > 1e-6)) s.crosses = false;
    return s;
}

std::optional<ShadowBoundaries> shadow_boundaries(const Enclosure& enclosure,
                                                  const SolveOptions& options) {
    if (options.refinement != Refinement::aligned || !asks_for(options, "shadow_boundary"))
        return {};
    return ShadowBoundaries(enclosure, options.direct_light == DirectLightMode::closed_form);
}

}  // namespace tyndall::radiosity
