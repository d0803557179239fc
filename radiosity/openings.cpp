#include "radiosity/openings.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "mesh/wall_openings.h"
#include "radiosity/closed_forms.h"
#include "radiosity/gather.h"
#include "radiosity/spherical_cubature.h"

namespace tyndall::radiosity {
namespace {

using std::numbers::pi;
using Opening = BrightOpenings::Opening;

// What is less bright than this, relative to what is before it, ordinary rays find well enough.
constexpr double bright = 2.0;
// So it is where they leave less noise than this, relative to what arrives, and where an opening
// takes up more than this share of all directions.
constexpr double notable_noise = 0.002, most_share = 0.25;
// Aimed rays: a share of the ordinary ones and at least so many, and twice as many as of those
// would go there.
constexpr std::size_t share_aimed = 8, least_aimed = 16, most_aimed = 4096;
// That a point aims at, the brightest: of many alike ordinary rays find enough.
constexpr std::size_t most_cones = 8;
// Of a scene, whose brightness is looked at; of an opening, for that.
constexpr std::size_t most_openings = 64, most_facets = 8;
// Of an opening's size: a point that is nearer to its plane lies in it.
constexpr double in_plane = 1e-6;

std::array<Point, 3> corners_of(const mesh::BaseMesh& mesh, FacetId facet) {
    std::array<Point, 3> corners;
    for (int k = 0; k < 3; ++k) corners[k] = mesh.points[mesh.facets[facet.value].corners[k].value];
    return corners;
}

// Openings that light may pass, the largest: it may lead out of the hull.
std::vector<std::vector<FacetId>> openings_of(const Enclosure& enclosure) {
    const mesh::BaseMesh& mesh = enclosure.mesh;
    std::vector<std::vector<FacetId>> groups = mesh::wall_openings(mesh);
    std::erase_if(groups, [&](const auto& group) {
        const auto& tets = mesh.facets[group.front().value].tets;
        return std::ranges::any_of(tets, [&](TetId t) { return t.valid() && enclosure.solid(t); });
    });
    if (groups.size() <= most_openings) return groups;
    const auto area = [&](const auto& group) {
        double sum = 0.0;
        for (const FacetId f : group) sum += mesh::area(mesh, f);
        return sum;
    };
    std::ranges::stable_sort(groups, std::greater<>(), area);
    groups.resize(most_openings);
    return groups;
}

// Mean radiance that comes to an opening from one side, by area: at the middles of its facets, of
// some of them where there are many.
std::vector<double> arriving(const Enclosure& enclosure, const GatherScene& scene,
                             const OnPurpose& look, std::span<const FacetId> group, Direction away,
                             const PointSet& points, std::uint64_t seed) {
    const mesh::BaseMesh& mesh = enclosure.mesh;
    std::vector<double> sum(enclosure.bands, 0.0);
    std::vector<Gathered> here(enclosure.bands);
    double area = 0.0;
    for (std::size_t k = 0; k < group.size(); k += 1 + group.size() / most_facets) {
        const FacetId f = group[k];
        const bool front = glm::dot(mesh::normal(mesh, f), away) > 0.0;
        const double weight = mesh::area(mesh, f);
        area += weight;
        if (!mesh.facets[f.value].tets[front ? 0 : 1].valid()) {
            for (std::size_t b = 0; b < sum.size(); ++b)
                sum[b] += weight * enclosure.environment[b];
            continue;
        }
        const auto corners = corners_of(mesh, f);
        const GatherPoint point{(corners[0] + corners[1] + corners[2]) / 3.0,
                                mesh::start_on(mesh, f, front ? Side::front : Side::back), away};
        gather(scene, look, point, points, hash_seed(seed, f.value), here);
        for (std::size_t b = 0; b < sum.size(); ++b) sum[b] += weight * here[b].mean;
    }
    for (double& value : sum) value /= area;
    return sum;
}

double brightest(const std::vector<double>& there, const std::vector<double>& here) {
    double most = 0.0;
    for (std::size_t b = 0; b < there.size(); ++b)
        if (there[b] > 0.0) most = std::max(most, there[b] / std::max(here[b], 1e-6 * there[b]));
    return most;
}

}  // namespace

BrightOpenings::BrightOpenings(const Enclosure& enclosure, const GatherScene& scene,
                               const OnPurpose& look, std::uint64_t seed)
    : points_(most_aimed) {
    const PointSet points(256);
    for (const auto& group : openings_of(enclosure)) {
        Opening opening;
        opening.normal = mesh::normal(enclosure.mesh, group.front());
        const auto before = arriving(enclosure, scene, look, group, opening.normal, points, seed);
        const auto behind = arriving(enclosure, scene, look, group, -opening.normal, points, seed);
        opening.brightness = {brightest(behind, before), brightest(before, behind)};
        if (*std::ranges::max_element(opening.brightness) < bright) continue;
        for (const FacetId f : group) {
            opening.triangles.push_back(corners_of(enclosure.mesh, f));
            for (const Point& p : opening.triangles.back())
                opening.centre += p / (3.0 * double(group.size()));
        }
        for (const auto& triangle : opening.triangles)
            for (const Point& p : triangle)
                opening.radius = std::max(opening.radius, glm::distance(p, opening.centre));
        openings_.push_back(std::move(opening));
    }
}

void OpeningCones::clear() {
    cones_.clear();
    pieces_.clear();
    aimed_.clear();
}

void OpeningCones::look(const BrightOpenings& openings, Point x, Direction normal, std::size_t rays,
                        std::uint64_t seed) {
    clear();
    const bool on_surface = normal != Direction(0.0);
    for (const Opening& opening : openings.all()) {
        const Point to = opening.centre - x;
        const double height = -glm::dot(opening.normal, to);
        const double brightness = opening.brightness[height > 0.0 ? 0 : 1];
        if (brightness < bright || std::abs(height) < in_plane * opening.radius) continue;
        if (on_surface && glm::dot(normal, to) < -opening.radius) continue;
        double solid = 0.0, share = 0.0;
        for (auto triangle : opening.triangles) {
            for (Point& p : triangle) p -= x;
            const double omega = solid_angle(triangle);
            const Point middle = (triangle[0] + triangle[1] + triangle[2]) / 3.0;
            solid += omega;
            share += on_surface
                         ? omega * std::max(0.0, glm::dot(normal, glm::normalize(middle))) / pi
                         : omega / (4.0 * pi);
        }
        const double noise = brightness * std::sqrt(share / static_cast<double>(rays));
        if (noise >= notable_noise && share <= most_share && solid <= most_share * 4.0 * pi)
            cones_.push_back({&opening, noise, share, 0});
    }
    if (cones_.size() > most_cones) {
        std::ranges::stable_sort(cones_, std::greater<>(), &Cone::noise);
        cones_.resize(most_cones);
    }
    for (std::size_t k = 0; k < cones_.size(); ++k) {
        for (auto triangle : cones_[k].opening->triangles) {
            for (Point& p : triangle) p = glm::normalize(p - x);
            add_pieces(triangle[0], triangle[1], triangle[2]);
        }
        cones_[k].end = pieces_.size();
        const auto found =
            static_cast<std::size_t>(2.0 * cones_[k].share * static_cast<double>(rays));
        const std::size_t count = std::bit_ceil(std::max(least_aimed, rays / share_aimed) + found);
        aim(k, openings.points(), std::min(count, most_aimed), normal, hash_seed(seed, k));
    }
}

void OpeningCones::add_pieces(Direction a, Direction b, Direction c) {
    over_short_triangles(a, b, c, [&](Direction a, Direction b, Direction c) {
        if (glm::dot(a, glm::cross(b, c)) < 0.0) std::swap(b, c);
        const std::array<Direction, 3> corners{a, b, c};
        const double omega = solid_angle(corners);
        if (omega > 0.0)
            pieces_.push_back(
                {corners, {glm::cross(a, b), glm::cross(b, c), glm::cross(c, a)}, omega});
    });
}

// Whether a direction is within one of the first so many cones.
bool OpeningCones::cover(Direction d, std::size_t cones) const {
    const std::size_t end = cones == 0 ? 0 : cones_[cones - 1].end;
    return std::any_of(pieces_.begin(), pieces_.begin() + end, [&](const Piece& piece) {
        return std::ranges::all_of(piece.edges,
                                   [&](const Direction& edge) { return glm::dot(edge, d) >= 0.0; });
    });
}

// Directions spread evenly over the solid angle of a cone; those that lie in one before it as well
// have been aimed there.
void OpeningCones::aim(std::size_t cone, const PointSet& points, std::size_t count,
                       Direction normal, std::uint64_t seed) {
    const std::size_t begin = cone == 0 ? 0 : cones_[cone - 1].end, end = cones_[cone].end;
    double solid = 0.0;
    for (std::size_t k = begin; k < end; ++k) solid += pieces_[k].solid_angle;
    if (begin == end) return;
    const bool on_surface = normal != Direction(0.0);
    for (std::size_t i = 0; i < count; ++i) {
        const auto numbers = points(i, seed);
        double u = numbers[0] * solid;
        std::size_t k = begin;
        while (k + 1 < end && u >= pieces_[k].solid_angle) u -= pieces_[k++].solid_angle;
        const Piece& piece = pieces_[k];
        const auto at = uniform_in_triangle(std::min(u / piece.solid_angle, 1.0), numbers[1]);
        const auto& [a, b, c] = piece.corners;
        const Direction towards = at[0] * a + at[1] * b + at[2] * c;
        const double length = glm::length(towards);
        const Direction d = towards / length;
        // Spread evenly over the plane triangle: a bit of it takes up dω of the sphere.
        const double volume = std::abs(glm::dot(a, glm::cross(b - a, c - a)));
        const double d_omega = 0.5 * volume / (length * length * length);
        const double density = piece.solid_angle / solid / d_omega;  // [1/sr]
        const double kernel = on_surface ? std::max(0.0, glm::dot(normal, d)) / pi : 0.25 / pi;
        if (kernel > 0.0 && !cover(d, cone))
            aimed_.push_back({d, kernel / (density * static_cast<double>(count)), 2 * i < count});
    }
}

}  // namespace tyndall::radiosity
