#include "radiosity/shining_lights.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "mesh/convex_merge.h"
#include "radiosity/closed_forms.h"
#include "radiosity/element_faces.h"
#include "radiosity/light_sources.h"

namespace tyndall::radiosity {

bool shines(const Spectrum& spectrum) {
    return std::any_of(spectrum.begin(), spectrum.end(), [](double v) { return v != 0.0; });
}

namespace {

using std::numbers::pi;

// Power [W] per irradiance across the beam that enters through the hull into where light can be
// [m^2].
double beam_area(const Enclosure& enclosure, Direction direction) {
    const auto& mesh = enclosure.mesh;
    double sum = 0.0;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        if (enclosure.solid(TetId(t))) continue;
        for (int k = 0; k < 4; ++k) {
            if (mesh.neighbours[t][k].valid()) continue;
            std::array<Point, 4> p;
            for (int c = 0; c < 4; ++c) p[c] = mesh.points[mesh.tets[t][c].value];
            const Point &a = p[(k + 1) % 4], &b = p[(k + 2) % 4], &c = p[(k + 3) % 4];
            Direction inward = 0.5 * glm::cross(b - a, c - a);
            if (glm::dot(inward, p[k] - a) < 0.0) inward = -inward;
            sum += std::max(0.0, glm::dot(inward, direction));
        }
    }
    return sum;
}

Spectrum scaled(const Spectrum& spectrum, double factor) {
    Spectrum result = spectrum;
    for (double& v : result) v *= factor;
    return result;
}

class Finder {
  public:
    Finder(const Enclosure& enclosure, double tolerance)
        : enclosure_(enclosure),
          merge_distance_(tolerance *
                          glm::distance(enclosure.mesh.hull_min, enclosure.mesh.hull_max)) {}

    void add_emitters();
    void add_light(const Light& light);
    void find_cones();
    ShiningLights take() { return std::move(found_); }

  private:
    void add_emitter(const SurfaceSide& side,
                     const std::vector<std::array<mesh::VertexId, 3>>& triangles);

    const Enclosure& enclosure_;
    double merge_distance_;  // [m]
    ShiningLights found_;
};

void Finder::add_emitters() {
    std::vector<std::vector<std::array<mesh::VertexId, 3>>> triangles(enclosure_.sides.size());
    for (std::size_t f = 0; f < enclosure_.facet_sides.size(); ++f)
        for (int k = 0; k < 2; ++k) {
            const auto side = enclosure_.facet_sides[f][k];
            const auto& facet = enclosure_.mesh.facets[f];
            if (side == none || !shines(enclosure_.sides[side])) continue;
            if (!facet.tets[k].valid() || enclosure_.solid(facet.tets[k])) continue;
            auto corners = facet.corners;
            if (k == 1) std::swap(corners[1], corners[2]);
            triangles[side].push_back(corners);
        }
    for (std::size_t s = 0; s < triangles.size(); ++s)
        if (!triangles[s].empty()) add_emitter(enclosure_.sides[s], triangles[s]);
}

void Finder::add_emitter(const SurfaceSide& side,
                         const std::vector<std::array<mesh::VertexId, 3>>& triangles) {
    const auto& points = enclosure_.mesh.points;
    double area = 0.0;
    for (const auto& t : triangles)
        area += 0.5 * glm::length(glm::cross(points[t[1].value] - points[t[0].value],
                                             points[t[2].value] - points[t[0].value]));
    for (auto& polygon : mesh::convex_merge(points, triangles, mesh::Facing::kept, merge_distance_))
        found_.areas.push_back(
            {std::move(polygon.corners), polygon.normal, mesh::Reach::finite, side.emission});
    found_.powers.push_back({side.name, scaled(side.emission, pi * area)});
}

void Finder::add_light(const Light& light) {
    Spectrum power;
    if (const auto* sun = std::get_if<Sun>(&light.source)) {
        Sun beam = *sun;
        beam.direction = glm::normalize(beam.direction);
        power = scaled(beam.irradiance, beam_area(enclosure_, beam.direction));
        if (beam.angle > 0.0 && shines(beam.irradiance)) {
            auto corners = sun_disc(beam);
            const double across = projected_solid_angle(corners, -beam.direction);
            found_.areas.push_back({std::move(corners), beam.direction, mesh::Reach::infinite,
                                    scaled(beam.irradiance, 1.0 / across)});
        } else if (shines(beam.irradiance)) {
            found_.beams.push_back(beam);
        }
    } else if (const auto* point = std::get_if<PointLight>(&light.source)) {
        power = scaled(point->intensity, 4.0 * pi);
        if (shines(point->intensity)) found_.points.push_back(*point);
    } else if (const auto* spot = std::get_if<SpotLight>(&light.source)) {
        power = scaled(spot->intensity, spot_solid_angle(*spot));
        if (shines(spot->intensity)) found_.spots.push_back(*spot);
    }
    found_.powers.push_back({light.name, std::move(power)});
}

void Finder::find_cones() {
    for (const AreaLight& area : found_.areas) {
        LightCone cone;
        for (const Point& corner : area.corners)
            cone.centre += corner / static_cast<double>(area.corners.size());
        if (area.reach == mesh::Reach::infinite) {
            cone.infinite = true;
            cone.towards = glm::normalize(cone.centre);
            for (const Point& corner : area.corners)
                cone.half_angle =
                    std::max(cone.half_angle,
                             std::acos(std::clamp(glm::dot(glm::normalize(corner), cone.towards),
                                                  -1.0, 1.0)));
        } else {
            for (const Point& corner : area.corners)
                cone.radius = std::max(cone.radius, glm::distance(corner, cone.centre));
        }
        found_.cones.push_back(cone);
    }
    for (const Sun& sun : found_.beams)
        found_.cones.push_back({true, Point(0), 0.0, -sun.direction, 0.0});
    for (const PointLight& light : found_.points) found_.cones.push_back({false, light.position});
    for (const SpotLight& light : found_.spots) found_.cones.push_back({false, light.position});
}

}  // namespace

ShiningLights shining_lights(const Enclosure& enclosure, bool emitters, double tolerance) {
    Finder lights(enclosure, tolerance);
    if (emitters) lights.add_emitters();
    for (const Light& light : enclosure.lights) lights.add_light(light);
    lights.find_cones();
    return lights.take();
}

}  // namespace tyndall::radiosity
