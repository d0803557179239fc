#include "mesh/visible_polygon.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace tyndall::mesh {
namespace {

constexpr double sliver = 1e-12;  // thickness, relative to distance, below which nothing is seen
constexpr double widest_cone = 0.05;  // cosine beyond which a cone culls nothing worth the test
// A point on a plane is told to be on one side by a step this large (of the tolerance), if the
// step's direction is off the plane by more than this slope.
constexpr double step_size = 0.01, least_slope = 1e-3;
constexpr std::uint32_t no_polygon = 0xffffffffu;

// Signed distances of a polygon's corners from a plane, those of rounding size set to 0.
struct Sides {
    bool any_inside = false, any_outside = false;
};

Sides measure(std::span<const Point> polygon, const HalfSpace& plane, std::vector<double>& side) {
    Sides sides;
    side.resize(polygon.size());
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Point& p = polygon[k];
        double d = glm::dot(plane.normal, p) - plane.offset;
        const double eps = sliver * (std::abs(p.x) + std::abs(p.y) + std::abs(p.z));
        if (std::abs(d) <= eps) d = 0.0;
        side[k] = d;
        sides.any_inside |= d > 0.0;
        sides.any_outside |= d < 0.0;
    }
    return sides;
}

// Appends to `out` the part where sign × side ≥ 0.
void keep(std::span<const Point> polygon, std::span<const double> side, double sign,
          std::vector<Point>& out) {
    for (std::size_t k = 0, n = polygon.size(); k < n; ++k) {
        const std::size_t l = k + 1 == n ? 0 : k + 1;
        const double a = sign * side[k], b = sign * side[l];
        if (a >= 0.0) out.push_back(polygon[k]);
        if (a * b < 0.0) out.push_back(polygon[k] + (polygon[l] - polygon[k]) * (a / (a - b)));
    }
}

// Planes through the point of view and a polygon's edges, the polygon on their positive side.
// turn: +1 if the polygon runs clockwise seen from there.
template <class Add>
void edge_planes(std::span<const Point> corners, double turn, Add&& add) {
    for (std::size_t k = 0, n = corners.size(); k < n; ++k) {
        const Point& a = corners[k];
        const Direction m = glm::cross(a, corners[k + 1 == n ? 0 : k + 1] - a);
        const double length = glm::length(m);
        if (length > 0.0) add(HalfSpace{m * (turn / length), 0.0});
    }
}

// Removes from scratch.visible what lies in all half spaces. False if there are too many parts.
bool subtract(std::span<const HalfSpace> shadow, std::size_t most, VisibleScratch& scratch) {
    ConvexParts& next = scratch.next;
    next.clear();
    for (std::size_t k = 0; k < scratch.visible.size(); ++k) {
        const auto part = scratch.visible[k];
        scratch.crossing.clear();
        bool apart = false;
        for (const HalfSpace& plane : shadow) {
            const Sides sides = measure(part, plane, scratch.side);
            if (sides.any_outside && !sides.any_inside) {
                apart = true;
                break;
            }
            if (sides.any_outside) scratch.crossing.push_back(plane);
        }
        if (apart) {
            next.add(part);
            continue;
        }
        const std::size_t corners = next.corners.size(), parts = next.size();
        scratch.ring.assign(part.begin(), part.end());
        for (const HalfSpace& plane : scratch.crossing) {
            const Sides sides = measure(scratch.ring, plane, scratch.side);
            if (!sides.any_outside) continue;
            if (!sides.any_inside) {  // the shadow passes by: leave the part whole
                next.corners.resize(corners);
                next.ends.resize(parts);
                next.add(part);
                break;
            }
            keep(scratch.ring, scratch.side, -1.0, next.corners);
            next.ends.push_back(static_cast<std::uint32_t>(next.corners.size()));
            scratch.inside.clear();
            keep(scratch.ring, scratch.side, 1.0, scratch.inside);
            scratch.ring.swap(scratch.inside);
        }
        if (next.size() > most) return false;
    }
    std::swap(scratch.visible, next);
    return true;
}

}  // namespace

void clip(std::span<const Point> polygon, Direction normal, double offset,
          std::vector<Point>& out) {
    thread_local std::vector<double> side;
    const Sides sides = measure(polygon, {normal, offset}, side);
    if (!sides.any_inside) return;
    keep(polygon, side, 1.0, out);
}

// What look() needs to know of its target, computed once.
struct Occluders::View {
    Point eye;
    const Target& target;
    std::span<const HalfSpace> edges;
    HalfSpace front{};  // the target's plane: its front, where occluders matter (finite)
    Direction axis{0};  // a cone around the target
    double cosine = 1.0, sine = 0.0;

    View(Point eye, const Target& target, std::vector<HalfSpace>& edge_planes_out)
        : eye(eye), target(target) {
        edge_planes_out.clear();
        edge_planes(target.corners, -1.0,
                    [&](const HalfSpace& h) { edge_planes_out.push_back(h); });
        edges = edge_planes_out;
        const auto corners = target.corners;
        Direction turn{0};
        for (std::size_t k = 1; k + 1 < corners.size(); ++k)
            turn += glm::cross(corners[k] - corners[0], corners[k + 1] - corners[0]);
        front.normal = glm::normalize(turn);
        front.offset = glm::dot(front.normal, corners[0]);
        for (const Point& p : corners) axis += glm::normalize(p);
        axis = glm::normalize(axis);
        for (const Point& p : corners)
            cosine = std::min(cosine, glm::dot(axis, p) / glm::length(p));
        sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    }

    bool misses(const Node& node) const {
        const Direction c = node.centre - eye;
        if (target.reach == Reach::finite &&
            glm::dot(front.normal, c) - front.offset < -node.radius)
            return true;
        if (glm::dot(target.horizon, c) < -node.radius) return true;
        if (cosine < widest_cone) return false;
        const double along = glm::dot(axis, c);
        const double across = std::sqrt(std::max(0.0, glm::dot(c, c) - along * along));
        return across * cosine - along * sine > node.radius;
    }
};

Occluders::Occluders(std::span<const ConvexPolygon> polygons, double tolerance)
    : tolerance_(tolerance) {
    std::vector<std::uint32_t> order;
    for (const ConvexPolygon& polygon : polygons) {
        order.push_back(static_cast<std::uint32_t>(planes_.size()));
        planes_.push_back({polygon.normal, glm::dot(polygon.normal, polygon.corners[0])});
        corners_.insert(corners_.end(), polygon.corners.begin(), polygon.corners.end());
        begin_.push_back(static_cast<std::uint32_t>(corners_.size()));
    }
    build(order);
}

Occluders::Node Occluders::bound(std::span<const std::uint32_t> polygons) const {
    Point low(std::numeric_limits<double>::infinity()), high = -low;
    for (const auto k : polygons)
        for (const Point& p : corners(k)) low = glm::min(low, p), high = glm::max(high, p);
    Node node{0.5 * (low + high), 0.0, 0, no_polygon};
    for (const auto k : polygons)
        for (const Point& p : corners(k))
            node.radius = std::max(node.radius, glm::distance(node.centre, p));
    node.radius += tolerance_;
    return node;
}

// Few polygons: a list of leaves. Many: halves by the longest axis of their centres.
void Occluders::build(std::span<std::uint32_t> polygons) {
    constexpr std::size_t list = 4;
    if (polygons.size() <= list || planes_.size() <= 8 * list) {
        for (const auto k : polygons) {
            Node leaf = bound({&k, 1});
            leaf.polygon = k;
            leaf.skip = static_cast<std::uint32_t>(nodes_.size() + 1);
            nodes_.push_back(leaf);
        }
        return;
    }
    const std::size_t here = nodes_.size();
    nodes_.push_back(bound(polygons));
    std::vector<std::pair<Point, std::uint32_t>> centres;
    Point low(std::numeric_limits<double>::infinity()), high = -low;
    for (const auto k : polygons) {
        centres.emplace_back(bound({&k, 1}).centre, k);
        low = glm::min(low, centres.back().first), high = glm::max(high, centres.back().first);
    }
    const Point extent = high - low;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                     : extent.y >= extent.z                       ? 1
                                                                  : 2;
    std::sort(centres.begin(), centres.end(), [axis](const auto& a, const auto& b) {
        return a.first[axis] != b.first[axis] ? a.first[axis] < b.first[axis] : a.second < b.second;
    });
    std::transform(centres.begin(), centres.end(), polygons.begin(),
                   [](const auto& c) { return c.second; });
    build(polygons.subspan(0, polygons.size() / 2));
    build(polygons.subspan(polygons.size() / 2));
    nodes_[here].skip = static_cast<std::uint32_t>(nodes_.size());
}

// all: polygon k hides nothing. none: everything. part: its shadow's half spaces are appended.
Visibility Occluders::cast_shadow(const View& view, std::uint32_t k,
                                  VisibleScratch& scratch) const {
    const auto& target = view.target;
    HalfSpace plane = planes_[k];
    plane.offset -= glm::dot(plane.normal, view.eye);
    Direction shift(0);
    double facing = plane.offset;  // positive: the point is behind the plane's front
    if (std::abs(plane.offset) <= tolerance_) {
        // On the plane: the limit of a point that comes near from inside. Planes through edges that
        // the point lies on are then spanned by edge and step, the others are the polygon's own.
        shift = step(plane.normal, target.inside);
        if (shift == Direction(0)) return Visibility::all;  // seen edge-on
        facing = -glm::dot(plane.normal, shift);
        plane.offset = 0.0;
    }
    double turn = 1.0;
    if (facing < 0.0) plane = {-plane.normal, -plane.offset}, turn = -1.0;

    bool all_hidden = true;
    if (target.reach == Reach::finite) {
        bool beyond = false;
        for (const Point& p : target.corners) {
            const double d = glm::dot(plane.normal, p) - plane.offset;
            beyond |= d > tolerance_;
            all_hidden &= d > tolerance_;
        }
        if (!beyond) return Visibility::all;
    }
    auto& q = scratch.relative;
    q.clear();
    bool in_front = target.reach == Reach::infinite, above = target.horizon == Direction(0);
    for (const Point& corner : corners(k)) {
        q.push_back(corner - view.eye - shift);
        in_front |= glm::dot(view.front.normal, q.back()) - view.front.offset > tolerance_;
        above |= glm::dot(target.horizon, q.back()) > tolerance_;
    }
    if (!in_front || !above) return Visibility::all;
    for (const HalfSpace& edge : view.edges)
        if (std::none_of(q.begin(), q.end(),
                         [&](const Point& p) { return glm::dot(edge.normal, p) > 0.0; }))
            return Visibility::all;

    const std::size_t begin = scratch.shadows.size();
    bool apart = false;
    edge_planes(q, turn, [&](const HalfSpace& edge) {
        if (apart) return;
        const Sides sides = measure(target.corners, edge, scratch.side);
        apart = !sides.any_inside;
        all_hidden &= !sides.any_outside;
        if (sides.any_outside) scratch.shadows.push_back(edge);
    });
    if (apart || all_hidden) {
        scratch.shadows.resize(begin);
        return apart ? Visibility::all : Visibility::none;
    }
    if (target.reach == Reach::finite) scratch.shadows.push_back(plane);
    scratch.shadow_ends.push_back(static_cast<std::uint32_t>(scratch.shadows.size()));
    return Visibility::part;
}

Visibility Occluders::look(Point eye, const Target& target, const VisibleLimits& limits,
                           VisibleScratch& scratch) const {
    scratch.visible.clear();
    if (target.corners.size() < 3) return Visibility::none;
    scratch.shadows.clear();
    scratch.shadow_ends.clear();
    const View view(eye, target, scratch.target_edges);
    for (std::size_t i = 0; i < nodes_.size();) {
        const Node& node = nodes_[i];
        if (view.misses(node)) {
            i = node.skip;
            continue;
        }
        ++i;
        if (node.polygon == no_polygon) continue;
        if (cast_shadow(view, node.polygon, scratch) == Visibility::none) return Visibility::none;
        if (scratch.shadow_ends.size() > limits.occluders) return Visibility::too_many;
    }
    scratch.visible.add(target.corners);
    if (scratch.shadow_ends.empty()) return Visibility::all;
    std::size_t begin = 0;
    for (const auto end : scratch.shadow_ends) {
        const std::span<const HalfSpace> shadow(scratch.shadows.data() + begin, end - begin);
        if (!subtract(shadow, limits.parts, scratch)) return Visibility::too_many;
        if (scratch.visible.size() == 0) return Visibility::none;
        begin = end;
    }
    return Visibility::part;
}

Direction Occluders::step(Direction normal, Direction inside) const {
    const double length = glm::length(inside);
    if (std::abs(glm::dot(normal, inside)) <= least_slope * length) return Direction(0);
    return inside * (step_size * tolerance_ / length);
}

bool Occluders::crosses(std::uint32_t k, Point eye, Direction path, Reach reach,
                        Direction inside) const {
    const HalfSpace& plane = planes_[k];
    double start = glm::dot(plane.normal, eye) - plane.offset;
    const double slope = glm::dot(plane.normal, path);
    const double end = start + slope;
    if (std::abs(start) <= tolerance_) {  // as in cast_shadow
        const Direction shift = step(plane.normal, inside);
        start = glm::dot(plane.normal, shift);
        eye += shift;
    }
    if (start * slope >= 0.0) return false;
    if (reach == Reach::finite && end * (start > 0.0 ? 1.0 : -1.0) >= -tolerance_) return false;
    const double turn = start < 0.0 ? 1.0 : -1.0;  // −1: its front looks to the eye
    const double length = glm::length(path);
    const auto polygon = corners(k);
    for (std::size_t c = 0, n = polygon.size(); c < n; ++c) {
        const Point& a = polygon[c];
        const Direction m = glm::cross(a - eye, polygon[c + 1 == n ? 0 : c + 1] - a);
        if (turn * glm::dot(m, path) < -sliver * glm::length(m) * length) return false;
    }
    return true;
}

bool Occluders::blocked(Point eye, Direction path, Reach reach, Direction inside) const {
    const double square = glm::dot(path, path);
    for (std::size_t i = 0; i < nodes_.size();) {
        const Node& node = nodes_[i];
        const Direction c = node.centre - eye;
        double t = std::max(0.0, glm::dot(c, path) / square);
        if (reach == Reach::finite) t = std::min(t, 1.0);
        const Direction nearest = c - path * t;
        if (glm::dot(nearest, nearest) > node.radius * node.radius) {
            i = node.skip;
            continue;
        }
        if (node.polygon != no_polygon && crosses(node.polygon, eye, path, reach, inside))
            return true;
        ++i;
    }
    return false;
}

}  // namespace tyndall::mesh
