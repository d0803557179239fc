#include "radiosity/bright_places.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesh/convex_merge.h"
#include "mesh/wall_openings.h"
#include "radiosity/gather.h"
#include "radiosity/open_places.h"
#include "radiosity/shining_lights.h"

namespace tyndall::radiosity {
namespace {

// Directions that are ever aimed at one place from a point.
constexpr std::size_t most_aimed = 4096;
// Brightness that is more counts no more: of a place beside one that is all but dark.
constexpr double most_brightness = 1e3;
// Rays that look for the brightness of a place, from each of some points.
constexpr std::size_t looks = 256;
// Of a scene, whose brightness is looked at; of an opening, for that.
constexpr std::size_t most_openings = 64, most_facets = 8;
// Of an opening that is aimed at: every ray of a gather is compared with all of them.
constexpr std::size_t most_triangles = 32;
// Radiance gained on the way past a lamp falls as one over how far away it is passed: balls about
// it, each so many times the size of the one before; the first is so many times the lamp's, or of
// the scene's size, as the last.
constexpr double about_lamp = 1.5, next_ball = 4.0;
constexpr double smallest_ball = 1.0 / 512.0, largest_ball = 1.0 / 16.0;
constexpr std::size_t most_lamps = 64;

// As few triangles as there may be for the same opening.
std::vector<std::array<Point, 3>> few_triangles(const mesh::BaseMesh& mesh,
                                                std::span<const FacetId> group) {
    std::vector<std::array<mesh::VertexId, 3>> facets;
    for (const FacetId f : group) facets.push_back(mesh.facets[f.value].corners);
    std::vector<std::array<Point, 3>> triangles;
    for (const auto& [corners, normal] : mesh::convex_merge(
             mesh.points, facets, mesh::Facing::ignored, merge_tolerance * mesh::diagonal(mesh)))
        for (std::size_t k = 2; k < corners.size(); ++k)
            triangles.push_back({corners[0], corners[k - 1], corners[k]});
    return triangles;
}

// Openings that light may pass, the largest: it may lead out of the hull.
std::vector<std::vector<FacetId>> openings_of(const Enclosure& enclosure) {
    const mesh::BaseMesh& mesh = enclosure.mesh;
    if (!mesh::has_interfaces(mesh)) return {};
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
        Point middle(0.0);
        for (const mesh::VertexId corner : mesh.facets[f.value].corners)
            middle += mesh.points[corner.value] / 3.0;
        const GatherPoint point{middle, mesh::start_on(mesh, f, front ? Side::front : Side::back),
                                away};
        gather(scene, look, point, points, hash_seed(seed, f.value), here);
        for (std::size_t b = 0; b < sum.size(); ++b) sum[b] += weight * here[b].mean;
    }
    for (double& value : sum) value /= area;
    return sum;
}

// Of all bands together: one that brings next to nothing does not count.
double brightness_of(const std::vector<double>& there, const std::vector<double>& here) {
    const double most = std::accumulate(there.begin(), there.end(), 0.0);
    const double around = std::accumulate(here.begin(), here.end(), 0.0);
    return most > 0.0 ? most / std::max(around, most / most_brightness) : 0.0;
}

// Spheres about what shines, those that lie close together in one.
struct Ball {
    Point centre;
    double radius;
};
// The smallest one about two.
Ball joined(const Ball& a, const Ball& b) {
    const Direction to = b.centre - a.centre;
    const double distance = glm::length(to);
    if (distance + b.radius <= a.radius) return a;
    if (distance + a.radius <= b.radius) return b;
    const double radius = 0.5 * (distance + a.radius + b.radius);
    return {a.centre + to / distance * (radius - a.radius), radius};
}

std::vector<Ball> lamps_of(const Enclosure& enclosure) {
    std::vector<Ball> lamps;
    for (const LightCone& light : shining_lights(enclosure, true, merge_tolerance).cones) {
        if (light.infinite) continue;
        const auto near = std::ranges::find_if(lamps, [&](const Ball& lamp) {
            return glm::distance(lamp.centre, light.centre) <= 2.0 * (lamp.radius + light.radius);
        });
        if (near != lamps.end())
            *near = joined(*near, {light.centre, light.radius});
        else if (lamps.size() < most_lamps)
            lamps.push_back({light.centre, light.radius});
    }
    return lamps;
}

// Where a ray may start; an invalid tet where no light can be.
TetId open_tet(const Enclosure& enclosure, Point x) {
    const TetId tet = mesh::locate(enclosure.mesh, x);
    return tet.valid() && !enclosure.solid(tet) && !covered(enclosure, x) ? tet : TetId();
}

// Mean radiance gained along chords of a ball.
std::vector<double> within(const Enclosure& enclosure, const GatherScene& scene, const Ball& ball,
                           const PointSet& points, std::uint64_t seed) {
    std::vector<double> sum(enclosure.bands, 0.0), radiance(enclosure.bands);
    for (std::size_t k = 0; k < points.size(); ++k) {
        const auto u = points(k, seed);
        const Direction outward = uniform_direction(u[3], u[4]);
        const Direction d = cosine_direction(-outward, u[0], u[1]);
        const Point x = ball.centre + ball.radius * outward;
        const TetId tet = open_tet(enclosure, x);
        if (!tet.valid()) continue;
        const mesh::Ray chord{x, d, -2.0 * ball.radius * glm::dot(d, outward)};
        radiance_along(scene, chord, {tet}, radiance);
        for (std::size_t b = 0; b < sum.size(); ++b)
            sum[b] += radiance[b] / static_cast<double>(points.size());
    }
    return sum;
}

// Mean of what arrives at points on a ball; empty where light can be at none of them.
std::vector<double> around(const Enclosure& enclosure, const GatherScene& scene,
                           const OnPurpose& look, const Ball& ball, const PointSet& points,
                           std::uint64_t seed) {
    std::vector<double> sum(enclosure.bands, 0.0);
    std::vector<Gathered> here(enclosure.bands);
    double count = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const Direction outward(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        const Point x = ball.centre + ball.radius * glm::normalize(outward);
        const TetId tet = open_tet(enclosure, x);
        if (!tet.valid()) continue;
        gather(scene, look, {x, {tet}}, points, hash_seed(seed, std::uint64_t(corner)), here);
        for (std::size_t b = 0; b < sum.size(); ++b) sum[b] += here[b].mean;
        count += 1.0;
    }
    if (count == 0.0) return {};
    for (double& value : sum) value /= count;
    return sum;
}

// How bright it is through an opening, if it may be aimed at.
BrightPlace looked_at(const Enclosure& enclosure, const GatherScene& scene, const OnPurpose& look,
                      std::span<const FacetId> group, std::uint64_t seed) {
    const PointSet points(looks);
    BrightPlace opening;
    opening.triangles = few_triangles(enclosure.mesh, group);
    if (opening.triangles.empty() || opening.triangles.size() > most_triangles) return opening;
    opening.normal = mesh::normal(enclosure.mesh, group.front());
    const auto before = arriving(enclosure, scene, look, group, opening.normal, points, seed);
    const auto behind = arriving(enclosure, scene, look, group, -opening.normal, points, seed);
    opening.brightness = {brightness_of(behind, before), brightness_of(before, behind)};
    const double corners = 3.0 * static_cast<double>(opening.triangles.size());
    for (const auto& triangle : opening.triangles)
        for (const Point& p : triangle) opening.centre += p / corners;
    for (const auto& triangle : opening.triangles)
        for (const Point& p : triangle)
            opening.radius = std::max(opening.radius, glm::distance(p, opening.centre));
    return opening;
}

// Balls about a lamp.
std::vector<BrightPlace> looked_at(const Enclosure& enclosure, const GatherScene& scene,
                                   const OnPurpose& look, const Ball& lamp, std::uint64_t seed) {
    const PointSet points(looks);
    const double size = mesh::diagonal(enclosure.mesh);
    const double smallest = std::max(about_lamp * lamp.radius, smallest_ball * size);
    Ball far{lamp.centre, largest_ball * size};
    std::vector<double> outside;
    for (; outside.empty() && far.radius >= smallest; far.radius /= next_ball)
        outside = around(enclosure, scene, look, far, points, seed);
    if (outside.empty()) return {};
    std::vector<BrightPlace> balls;
    for (double radius = smallest; radius <= largest_ball * size; radius *= next_ball) {
        const auto inside = within(enclosure, scene, {lamp.centre, radius}, points, seed);
        const double brightness = brightness_of(inside, outside);
        balls.push_back({{}, Direction(0.0), lamp.centre, radius, {brightness, brightness}});
    }
    return balls;
}

}  // namespace

bool may_be_bright_somewhere(const Enclosure& enclosure) {
    return mesh::has_interfaces(enclosure.mesh) ||
           (!enclosure.media.empty() && !lamps_of(enclosure).empty());
}

BrightPlaces::BrightPlaces(const Enclosure& enclosure, const GatherScene& scene,
                           const OnPurpose& look, std::uint64_t seed)
    : mesh_(enclosure.mesh), points_(most_aimed) {
    const auto openings = openings_of(enclosure);
    const auto lamps = enclosure.media.empty() ? std::vector<Ball>{} : lamps_of(enclosure);
    std::vector<std::vector<BrightPlace>> found(openings.size() + lamps.size());
    tbb::parallel_for(std::size_t(0), found.size(), [&](std::size_t k) {
        const std::uint64_t stream = hash_seed(seed, k);
        if (k < openings.size())
            found[k] = {looked_at(enclosure, scene, look, openings[k], stream)};
        else
            found[k] = looked_at(enclosure, scene, look, lamps[k - openings.size()], stream);
    });
    for (const auto& places : found)
        for (const BrightPlace& place : places)
            if (*std::ranges::max_element(place.brightness) >= bright) places_.push_back(place);
    std::ranges::stable_sort(places_, {}, [](const BrightPlace& place) {
        return place.is_opening() ? 0.0 : place.radius;
    });
}

}  // namespace tyndall::radiosity
