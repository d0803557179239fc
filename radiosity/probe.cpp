#include "radiosity/probe.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "mesh/input_error.h"
#include "radiosity/open_places.h"
#include "radiosity/temperatures.h"

namespace tyndall::radiosity {
namespace {

using std::numbers::pi;
constexpr double relative_step = 1e-7;  // of the scene's diagonal: beyond rounding, below notice

}  // namespace

Probe::Probe(const Solution& solution, const ProbeOptions& options)
    : solution_(solution),
      options_(options),
      scene_(*solution.enclosure, solution.forest, reflected_sources(solution)),
      light_(*solution.enclosure,
             {.emitters = solution.direct_light == DirectLightMode::closed_form}),
      points_(options.rays),
      step_(relative_step * diagonal(solution.enclosure->mesh)) {
    scene_.set_in_mirrors(sources_in_mirrors(solution));
    bright_.emplace(*solution.enclosure, scene_, OnPurpose{}, options_.seed);
}

// Off the faces of the tet that holds x, if it lies on one: a point in a wall's plane is on neither
// side of it. A point inside stays where it is.
Point Probe::off_faces(Point x, TetId tet) const {
    const auto& mesh = solution_.enclosure->mesh;
    std::array<Point, 4> p;
    for (int k = 0; k < 4; ++k) p[k] = mesh.points[mesh.tets[tet.value][k].value];
    double least = step_;
    for (int k = 0; k < 4; ++k) {
        const auto& [a, b, c] = mesh::face_corners[k];
        const Direction outward = glm::normalize(glm::cross(p[b] - p[a], p[c] - p[a]));
        least = std::min(least, glm::dot(outward, p[a] - x));
    }
    if (least > 0.1 * step_) return x;
    const Direction inward = 0.25 * (p[0] + p[1] + p[2] + p[3]) - x;
    return x + std::min(0.5, step_ / glm::length(inward)) * inward;
}

// The face of the tet that is a wall, x lies on, and the normal looks away from; none.
FacetId Probe::wall_at(Point x, Direction normal, TetId tet) const {
    const auto& mesh = solution_.enclosure->mesh;
    for (const FacetId facet : mesh.tet_facets[tet.value]) {
        if (!facet.valid() || mesh.facets[facet.value].opacity != mesh::Opacity::opaque) continue;
        const auto& wall = mesh.facets[facet.value];
        Direction inward = mesh::normal(mesh, facet);
        if (wall.tets[0] != tet) inward = -inward;
        const double height = glm::dot(inward, x - mesh.points[wall.corners[0].value]);
        if (glm::dot(inward, normal) > 0.99 && std::abs(height) < step_) return facet;
    }
    return {};
}

// The tet that holds x, or the point a step from it along the normal (0: none). Where walls meet,
// the tet that is found may lie behind one of them: a place just beside x counts, too, first of all
// one above a wall that x lies on.
Probe::Place Probe::place(Point x, Direction normal) const {
    const Enclosure& e = *solution_.enclosure;
    const Point stepped = x + step_ * normal;
    const TetId first = mesh::locate(e.mesh, stepped);
    std::vector<Place> places;
    const auto consider = [&](Point p, TetId tet) {
        if (tet.valid() && !e.solid(tet) && !covered(e, p))
            places.push_back({off_faces(p, tet), tet});
    };
    consider(stepped, first);
    const bool free = normal == Direction(0.0);
    if (!places.empty() && (free || wall_at(x, normal, first).valid())) return places.front();
    for (int k = 0; k < 27; ++k) {
        Direction offset(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
        offset -= glm::dot(offset, normal) * normal;
        const Point beside = stepped + 0.5 * step_ * offset;
        consider(beside, mesh::locate(e.mesh, beside, first.valid() ? first : TetId(0)));
    }
    for (const Place& place : places)
        if (wall_at(x, normal, place.tet).valid()) return place;
    if (!places.empty()) return places.front();
    throw mesh::InputError(fmt::format("the point [{}, {}, {}] {}. Move it{}.", x.x, x.y, x.z,
                                       first.valid() ? "lies in a solid" : "lies outside the scene",
                                       normal != Direction(0.0) ? ", or turn its normal" : ""));
}

std::vector<Gathered> Probe::gathered(const Place& place, Direction normal) const {
    std::vector<Gathered> incident(solution_.enclosure->bands);
    gather(scene_, {.bright = &*bright_}, {place.x, {place.tet}, normal}, points_, options_.seed,
           incident);
    return incident;
}

ZoneValues Probe::in_space(Point x) const {
    const Enclosure& e = *solution_.enclosure;
    const Place at = place(x, Direction(0.0));
    const auto indirect = gathered(at, Direction(0.0));
    Spectrum direct(e.bands);
    light_.at_zone(at.x, at.tet, direct);
    const auto medium = e.medium_of(at.tet);
    const ZoneId leaf = solution_.forest.leaf_at(mesh::root_zone(at.tet), at.x);
    ZoneValues values;
    Spectrum emitted, arriving;
    for (std::size_t b = 0; b < e.bands; ++b) {
        const double incident = direct[b] + indirect[b].mean;
        const double albedo = medium == none ? 0.0 : e.media[medium].albedo[b];
        const double emission = medium == none ? 0.0 : emission_of(solution_, leaf, b);
        values.source.push_back(emission + albedo * incident);
        values.source_direct.push_back(albedo * direct[b]);
        values.incident.push_back(4.0 * pi * incident);
        values.incident_direct.push_back(4.0 * pi * direct[b]);
        emitted.push_back(emission);
        arriving.push_back(incident);
    }
    if (e.thermal && medium != none)
        values.temperature = temperature_there(e.spectral, e.media[medium], emitted, arriving);
    return values;
}

PatchValues Probe::on_surface(Point x, Direction normal) const {
    const double length = glm::length(normal);
    if (!(length > 0.0) || !std::isfinite(length))
        throw mesh::InputError(
            fmt::format("the normal [{}, {}, {}] has no direction. Give another.", normal.x,
                        normal.y, normal.z));
    normal /= length;
    const Place at = place(x, normal);
    const auto indirect = gathered(at, normal);
    Spectrum direct(solution_.enclosure->bands);
    light_.at_patch(at.x, normal, at.tet, direct);
    PatchValues values;
    Spectrum arriving;
    for (std::size_t b = 0; b < direct.size(); ++b) {
        arriving.push_back(direct[b] + indirect[b].mean);
        values.irradiance.push_back(pi * arriving[b]);
        values.irradiance_direct.push_back(pi * direct[b]);
    }
    const Enclosure& e = *solution_.enclosure;
    const FacetId wall = e.thermal ? wall_at(x, normal, at.tet) : FacetId{};
    if (!wall.valid()) return values;
    const Side face = e.mesh.facets[wall.value].tets[0] == at.tet ? Side::front : Side::back;
    const auto side = e.facet_sides[wall.value][face == Side::back];
    if (side == none) return values;
    const PatchId leaf = solution_.forest.leaf_at(mesh::root_patch(wall, face), x);
    Spectrum emitted;
    for (std::size_t b = 0; b < e.bands; ++b) emitted.push_back(emission_of(solution_, leaf, b));
    values.temperature = temperature_there(e.spectral, e.sides[side], emitted, arriving);
    return values;
}

}  // namespace tyndall::radiosity
