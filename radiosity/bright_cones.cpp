#include "radiosity/bright_cones.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "radiosity/closed_forms.h"
#include "radiosity/spherical_cubature.h"

namespace tyndall::radiosity {
namespace {

using std::numbers::pi;

// Ordinary rays do where they leave less noise than this, relative to what arrives, and where a
// place, or all places together, take up more than these shares of all directions.
constexpr double notable_noise = 0.004, most_share = 0.25, most_together = 0.5;
// Aimed rays: a share of the ordinary ones, a place's at most so much and together not more than
// that of two places; at least so many, and twice as many as of the ordinary ones would go there.
constexpr std::size_t share_aimed = 8, least_aimed = 16;
// That a point aims at, the most noisy: of many alike ordinary rays find enough.
constexpr std::size_t most_cones = 8;
// With fewer ordinary rays than this some gathers would have none left.
constexpr std::size_t least_rays = 16;
// Of an opening's size: a point that is nearer to its plane lies in it.
constexpr double in_plane = 1e-6;

// What a direction counts, per solid angle: cosine-weighted on a surface [1/sr].
double kernel(const GatherPoint& point, Direction d) {
    return point.on_surface() ? std::max(0.0, glm::dot(point.normal, d)) / pi : 0.25 / pi;
}

bool sees(const mesh::BaseMesh& mesh, const GatherPoint& point, Direction path) {
    const double length = glm::length(path);
    const mesh::Ray ray{point.x, path / length, length};
    return mesh::walk(mesh, ray, point.start, [](TetId, double, double) { return true; }).arrival ==
           mesh::Arrival::ended;
}

// Whether nothing stands before a ball, or before the middle of one of an opening's triangles: what
// shows in part may be missed, and is left to ordinary rays then.
bool shows(const mesh::BaseMesh& mesh, const BrightPlace& place, const GatherPoint& point) {
    if (!place.is_opening()) {
        const Direction path = place.centre - point.x;
        return sees(mesh, point, (1.0 - place.radius / glm::length(path)) * path);
    }
    return std::ranges::any_of(place.triangles, [&](const std::array<Point, 3>& t) {
        return sees(mesh, point, (1.0 - 1e-6) * ((t[0] + t[1] + t[2]) / 3.0 - point.x));
    });
}

}  // namespace

void BrightCones::clear() {
    cones_.clear();
    pieces_.clear();
    aimed_.clear();
}

void BrightCones::look(const BrightPlaces& places, const GatherPoint& point, std::size_t rays,
                       std::uint64_t seed) {
    clear();
    if (rays < least_rays) return;
    const auto count = static_cast<double>(rays);
    for (const BrightPlace& place : places.all()) {
        Cone cone = place.is_opening() ? to_opening(place, point) : to_ball(place, point);
        cone.noise = cone.brightness * std::sqrt(cone.share / count);
        cone.aimed = static_cast<std::size_t>(2.0 * cone.share * count);
        if (cone.noise >= notable_noise && cone.share <= most_share &&
            cone.solid_angle <= most_share * 4.0 * pi && cone.aimed < places.points().size() / 2)
            cones_.push_back(cone);
    }
    choose(places.mesh(), point);
    const std::size_t each = rays * 2 / share_aimed / std::max<std::size_t>(2, cones_.size());
    for (std::size_t k = 0; k < cones_.size(); ++k) {
        Cone& cone = cones_[k];
        if (cone.place->is_opening()) add_pieces(*cone.place, point.x);
        cone.end = pieces_.size();
        const std::size_t aimed = std::bit_ceil(std::max(least_aimed, each) + cone.aimed);
        const auto which = static_cast<std::uint64_t>(cone.place - places.all().data());
        aim(k, places.points(), std::min(aimed, places.points().size()), point,
            hash_seed(seed, which));
    }
}

// The most noisy that show, in the order of their places.
void BrightCones::choose(const mesh::BaseMesh& mesh, const GatherPoint& point) {
    std::ranges::stable_sort(cones_, std::greater<>(), &Cone::noise);
    std::size_t chosen = 0;
    double share = 0.0;
    for (const Cone& cone : cones_) {
        if (chosen == most_cones) break;
        if (share + cone.share > most_together || !shows(mesh, *cone.place, point)) continue;
        share += cone.share;
        cones_[chosen++] = cone;
    }
    cones_.resize(chosen);
    std::ranges::sort(cones_, {}, &Cone::place);
}

void BrightCones::add_pieces(const BrightPlace& opening, Point x) {
    const auto add = [&](Direction a, Direction b, Direction c) {
        if (glm::dot(a, glm::cross(b, c)) < 0.0) std::swap(b, c);
        const double omega = solid_angle(std::array{a, b, c});
        if (omega > 0.0)
            pieces_.push_back(
                {{a, b, c}, {glm::cross(a, b), glm::cross(b, c), glm::cross(c, a)}, omega});
    };
    for (auto corners : opening.triangles) {
        for (Point& p : corners) p = glm::normalize(p - x);
        over_short_triangles(corners[0], corners[1], corners[2], add);
    }
}

BrightCones::Cone BrightCones::to_opening(const BrightPlace& opening, const GatherPoint& point) {
    Cone cone{.place = &opening};
    cone.height = glm::dot(opening.normal, point.x - opening.centre);
    if (std::abs(cone.height) < in_plane * opening.radius) return cone;
    cone.brightness = opening.brightness[cone.height > 0.0 ? 0 : 1];
    if (cone.brightness < bright) return {.place = &opening};
    for (auto triangle : opening.triangles) {
        for (Point& p : triangle) p -= point.x;
        const double omega = solid_angle(triangle);
        const Point middle = (triangle[0] + triangle[1] + triangle[2]) / 3.0;
        cone.solid_angle += omega;
        cone.share += omega * kernel(point, glm::normalize(middle));
    }
    return cone;
}

BrightCones::Cone BrightCones::to_ball(const BrightPlace& ball, const GatherPoint& point) {
    Cone cone{.place = &ball};
    const Point to = ball.centre - point.x;
    const double distance = glm::length(to), sine = ball.radius / distance;
    if (!(sine < 1.0) || (point.on_surface() && !(glm::dot(point.normal, to) > 0.0))) return cone;
    cone.brightness = ball.brightness[0];
    cone.axis = to / distance;
    cone.cosine = std::sqrt(1.0 - sine * sine);
    cone.solid_angle = 2.0 * pi * sine * sine / (1.0 + cone.cosine);
    cone.share = cone.solid_angle * kernel(point, cone.axis);
    return cone;
}

std::size_t BrightCones::first_cone(Direction d, std::size_t cones) const {
    std::size_t piece = 0;
    for (std::size_t k = 0; k < cones; ++k) {
        const Cone& cone = cones_[k];
        if (!cone.place->is_opening()) {
            const double along = glm::dot(cone.axis, d);
            if (along > 0.0 && along * along >= cone.cosine * cone.cosine * glm::dot(d, d))
                return k;
        }
        for (; piece < cone.end; ++piece)
            if (std::ranges::all_of(pieces_[piece].edges, [&](const Direction& edge) {
                    return glm::dot(edge, d) >= 0.0;
                }))
                return k;
    }
    return cones;
}

bool BrightCones::bring_lit(Direction path) const {
    const std::size_t k = first_cone(path, cones_.size());
    if (k == cones_.size() || !cones_[k].place->is_opening()) return false;
    const double height = cones_[k].height;
    return (height + glm::dot(cones_[k].place->normal, path) > 0.0) != (height > 0.0);
}

// A direction in a cone by two numbers in [0, 1), spread evenly over its solid angle or nearly
// so, and one over its density [sr].
std::pair<Direction, double> BrightCones::in_opening(std::size_t cone, double u, double v) const {
    std::size_t k = cone == 0 ? 0 : cones_[cone - 1].end;
    const double solid = cones_[cone].solid_angle;
    u *= solid;
    while (k + 1 < cones_[cone].end && u >= pieces_[k].solid_angle) u -= pieces_[k++].solid_angle;
    const Piece& piece = pieces_[k];
    const auto at = uniform_in_triangle(std::min(u / piece.solid_angle, 1.0), v);
    const auto& [a, b, c] = piece.corners;
    const Direction towards = at[0] * a + at[1] * b + at[2] * c;
    const double length = glm::length(towards);
    // Evenly over the plane triangle, of which a bit takes up this much of the sphere.
    const double volume = std::abs(glm::dot(a, glm::cross(b - a, c - a)));
    return {towards / length,
            0.5 * volume / (length * length * length) * solid / piece.solid_angle};
}

std::pair<Direction, double> BrightCones::in_ball(const Cone& cone, double u, double v) const {
    return {direction_about(cone.axis, 1.0 - u * (1.0 - cone.cosine), v), cone.solid_angle};
}

// Those that lie in a cone before this one as well have been aimed there.
void BrightCones::aim(std::size_t k, const PointSet& points, std::size_t count,
                      const GatherPoint& point, std::uint64_t seed) {
    const Cone& cone = cones_[k];
    const bool opening = cone.place->is_opening();
    if (opening && cone.end == (k == 0 ? 0 : cones_[k - 1].end)) return;  // too thin for its pieces
    for (std::size_t i = 0; i < count; ++i) {
        const auto u = points(i, seed);
        const auto [d, solid] = opening ? in_opening(k, u[0], u[1]) : in_ball(cone, u[0], u[1]);
        const double weight = kernel(point, d) * solid / static_cast<double>(count);
        if (!(weight > 0.0) || first_cone(d, k) < k) continue;
        const double lit_beyond =
            opening ? -cone.height / glm::dot(cone.place->normal, d) : mesh::infinity;
        aimed_.push_back({d, weight, 2 * i < count, lit_beyond});
    }
}

}  // namespace tyndall::radiosity
