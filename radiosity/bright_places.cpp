#include "radiosity/bright_places.h"

#include <algorithm>
#include <cmath>

#include "mesh/wall_openings.h"
#include "radiosity/gather.h"
#include "radiosity/open_places.h"
#include "radiosity/shining_lights.h"

namespace tyndall::radiosity {
namespace {

// Directions that are ever aimed at one place from a point.
constexpr std::size_t most_aimed = 4096;
// Rays that look for the brightness of a place, from each of some points.
constexpr std::size_t looks = 256;
// Of a scene, whose brightness is looked at; of an opening, for that.
constexpr std::size_t most_openings = 64, most_facets = 8;
// Radiance gained on the way past a lamp falls as one over how far away it is passed: balls about
// it, each so many times the size of the one before; the first is so many times the lamp's, or of
// the scene's size, as the last.
constexpr double about_lamp = 1.5, next_ball = 4.0;
constexpr double smallest_ball = 1.0 / 512.0, largest_ball = 1.0 / 16.0;
constexpr std::size_t most_lamps = 64;
constexpr double corner_tolerance = 1e-9;  // as direct light has it

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

// Spheres about what shines, those that lie close together in one.
struct Ball {
    Point centre;
    double radius;
};
std::vector<Ball> lamps_of(const Enclosure& enclosure) {
    std::vector<Ball> lamps;
    for (const LightCone& light : shining_lights(enclosure, true, corner_tolerance).cones) {
        if (light.infinite) continue;
        const auto near = std::ranges::find_if(lamps, [&](const Ball& lamp) {
            return glm::distance(lamp.centre, light.centre) <= 2.0 * (lamp.radius + light.radius);
        });
        if (near == lamps.end()) {
            lamps.push_back({light.centre, light.radius});
            continue;
        }
        const Point to = light.centre - near->centre;
        const double distance = glm::length(to);
        if (distance + light.radius <= near->radius) continue;
        const double radius =
            std::max(0.5 * (distance + near->radius + light.radius), light.radius);
        if (distance > 0.0) near->centre += to / distance * (radius - near->radius);
        near->radius = radius;
    }
    if (lamps.size() > most_lamps) lamps.resize(most_lamps);
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

// Mean of what arrives at points on a ball.
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
    for (double& value : sum) value /= std::max(count, 1.0);
    return sum;
}

}  // namespace

bool may_be_bright_somewhere(const Enclosure& enclosure) {
    return mesh::has_interfaces(enclosure.mesh) ||
           (!enclosure.media.empty() && !lamps_of(enclosure).empty());
}

BrightPlaces::BrightPlaces(const Enclosure& enclosure, const GatherScene& scene,
                           const OnPurpose& look, std::uint64_t seed)
    : mesh_(enclosure.mesh), points_(most_aimed) {
    add_openings(enclosure, scene, look, seed);
    if (!enclosure.media.empty()) add_balls(enclosure, scene, look, seed);
}

void BrightPlaces::add_openings(const Enclosure& enclosure, const GatherScene& scene,
                                const OnPurpose& look, std::uint64_t seed) {
    const PointSet points(looks);
    for (const auto& group : openings_of(enclosure)) {
        BrightPlace opening;
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
        places_.push_back(std::move(opening));
    }
}

void BrightPlaces::add_balls(const Enclosure& enclosure, const GatherScene& scene,
                             const OnPurpose& look, std::uint64_t seed) {
    const PointSet points(looks);
    const double size = mesh::diagonal(enclosure.mesh);
    const std::vector<Ball> lamps = lamps_of(enclosure);
    for (std::size_t k = 0; k < lamps.size(); ++k) {
        const Point centre = lamps[k].centre;
        const std::uint64_t stream = hash_seed(seed, k);
        const double largest = largest_ball * size;
        const auto outside = around(enclosure, scene, look, {centre, largest}, points, stream);
        double radius = std::max(about_lamp * lamps[k].radius, smallest_ball * size);
        for (; radius <= largest; radius *= next_ball) {
            const double brightness =
                brightest(within(enclosure, scene, {centre, radius}, points, stream), outside);
            if (brightness >= bright)
                places_.push_back({{}, Direction(0.0), centre, radius, {brightness}});
        }
    }
}

}  // namespace tyndall::radiosity
