#include "render/path_lights.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "radiosity/light_sources.h"

namespace tyndall::render {
namespace {

using radiosity::none;
using std::numbers::pi;

double mean(const Spectrum& s) {
    double sum = 0.0;
    for (const double v : s) sum += std::abs(v);
    return sum / double(s.size());
}

// The unit vectors across w.
std::array<Direction, 2> across(Direction w) {
    const Direction axis = std::abs(w.x) < 0.6 ? Direction(1, 0, 0) : Direction(0, 1, 0);
    const Direction u = glm::normalize(glm::cross(axis, w));
    return {u, glm::cross(w, u)};
}

// Of the sun's disc [sr]: 2π (1 − cos) of its half angle.
double disc_solid_angle(const radiosity::Sun& sun) {
    return 4.0 * pi * std::pow(std::sin(0.25 * sun.angle), 2);
}

// ∫ cosθ dω over the disc: what its radiance is multiplied by to give the irradiance [sr].
double disc_projected(const radiosity::Sun& sun) {
    return pi * std::pow(std::sin(0.5 * sun.angle), 2);
}

}  // namespace

PathLights::PathLights(const radiosity::Enclosure& e) : e_(e) {
    of_facet_.assign(2 * e.facet_sides.size(), none);
    for (std::size_t f = 0; f < e.facet_sides.size(); ++f)
        for (std::uint32_t k = 0; k < 2; ++k) {
            const auto side = e.facet_sides[f][k];
            if (side == none) continue;
            const double area = mesh::area(e.mesh, mesh::FacetId(f));
            add(Kind::facet, std::uint32_t(2 * f + k), pi * area * mean(e.sides[side].emission),
                area);
        }
    const auto extent = e.mesh.hull_max - e.mesh.hull_min;
    const double hull = 2.0 * (extent.x * extent.y + extent.y * extent.z + extent.z * extent.x);
    for (std::uint32_t l = 0; l < e.lights.size(); ++l) {
        const auto& source = e.lights[l].source;
        if (const auto* sun = std::get_if<radiosity::Sun>(&source)) {
            const bool disc = sun->angle > 0.0;
            add(disc ? Kind::sun_disc : Kind::sun_parallel, l, 0.25 * hull * mean(sun->irradiance),
                disc ? disc_solid_angle(*sun) : 1.0);
        } else if (const auto* point = std::get_if<radiosity::PointLight>(&source)) {
            add(Kind::point, l, 4.0 * pi * mean(point->intensity), 1.0);
        } else if (const auto* spot = std::get_if<radiosity::SpotLight>(&source)) {
            add(Kind::spot, l, radiosity::spot_solid_angle(*spot) * mean(spot->intensity), 1.0);
        }
    }
    add(Kind::environment, 0, pi * hull * mean(e.environment), 4.0 * pi);
    double sum = 0.0;
    for (const auto& light : lights_) sum += light.probability;
    double so_far = 0.0;
    for (std::uint32_t l = 0; l < lights_.size(); ++l) {
        OneLight& light = lights_[l];
        light.probability /= sum;
        light.density *= light.probability;
        cumulated_.push_back(so_far += light.probability);
        if (light.kind == Kind::facet) of_facet_[light.index] = l;
        if (light.kind == Kind::sun_disc) suns_.push_back(l);
        if (light.kind == Kind::environment) environment_ = light.probability;
    }
}

void PathLights::add(Kind kind, std::uint32_t index, double power, double measure) {
    if (power > 0.0) lights_.push_back({kind, power, index, 1.0 / measure});
}

LightPlace PathLights::choose(RandomNumbers& random) const {
    const auto found = std::upper_bound(cumulated_.begin(), cumulated_.end(), random());
    LightPlace place;
    place.light = std::uint32_t(
        std::min<std::size_t>(std::size_t(found - cumulated_.begin()), lights_.size() - 1));
    const OneLight& light = lights_[place.light];
    const double u = random(), v = random();
    switch (light.kind) {
        case Kind::facet: {
            const auto& corners = e_.mesh.facets[light.index / 2].corners;
            const auto w = radiosity::uniform_in_triangle(u, v);
            for (int k = 0; k < 3; ++k) place.at += w[k] * e_.mesh.points[corners[k].value];
            return place;
        }
        case Kind::point:
            place.at = std::get<radiosity::PointLight>(e_.lights[light.index].source).position;
            return place;
        case Kind::spot:
            place.at = std::get<radiosity::SpotLight>(e_.lights[light.index].source).position;
            return place;
        case Kind::environment:
            place.towards = radiosity::uniform_direction(u, v);
            break;
        case Kind::sun_parallel:
        case Kind::sun_disc: {
            const auto& sun = std::get<radiosity::Sun>(e_.lights[light.index].source);
            const Direction axis = -glm::normalize(sun.direction);
            const double depth = 2.0 * u * std::pow(std::sin(0.25 * sun.angle), 2);  // 1 − cos
            const double sine = std::sqrt(std::max(0.0, depth * (2.0 - depth)));
            const auto [a, b] = across(axis);
            place.towards = (1.0 - depth) * axis +
                            sine * (std::cos(2.0 * pi * v) * a + std::sin(2.0 * pi * v) * b);
        }
    }
    place.infinite = true;
    return place;
}

bool PathLights::from(const LightPlace& place, Point x, FromLight& result) const {
    const OneLight& light = lights_[place.light];
    const std::size_t bands = e_.bands;
    result.direct = light.kind != Kind::environment;
    result.facet = light.kind == Kind::facet;
    result.density = 0.0;
    result.irradiance.resize(bands);
    const auto fill = [&](const Spectrum& strength, double factor) {
        for (std::size_t b = 0; b < bands; ++b) result.irradiance[b] = strength[b] * factor;
    };
    if (place.infinite) {
        result.direction = place.towards;
        result.distance = std::numeric_limits<double>::infinity();
        if (light.kind == Kind::environment) {
            result.density = light.density;
            fill(e_.environment, 1.0 / light.density);
            return true;
        }
        const auto& sun = std::get<radiosity::Sun>(e_.lights[light.index].source);
        if (light.kind == Kind::sun_disc) {
            result.density = light.density;
            fill(sun.irradiance, 1.0 / (disc_projected(sun) * light.density));
        } else {
            fill(sun.irradiance, 1.0 / light.probability);
        }
        return true;
    }
    const Direction path = place.at - x;
    const double square = glm::dot(path, path);
    if (!(square > 0.0)) return false;
    result.distance = std::sqrt(square);
    result.direction = path / result.distance;
    if (light.kind == Kind::facet) {
        const std::size_t f = light.index / 2;
        const bool back = light.index % 2 == 1;
        const double slope = glm::dot(mesh::normal(e_.mesh, mesh::FacetId(f)), result.direction);
        const double cosine = back ? slope : -slope;
        if (!(cosine > 0.0)) return false;
        result.density = light.density * square / cosine;
        fill(e_.sides[e_.facet_sides[f][back]].emission, 1.0 / result.density);
        return true;
    }
    const auto& source = e_.lights[light.index].source;
    if (const auto* spot = std::get_if<radiosity::SpotLight>(&source)) {
        const double share = radiosity::spot_share(*spot, -result.direction);
        fill(spot->intensity, share / (square * light.probability));
        return share > 0.0;
    }
    fill(std::get<radiosity::PointLight>(source).intensity, 1.0 / (square * light.probability));
    return true;
}

double PathLights::density(mesh::FacetId facet, mesh::Side side, double distance,
                           double cosine) const {
    const auto light = of_facet_[2 * facet.value + (side == mesh::Side::back)];
    if (light == none || !(cosine > 0.0)) return 0.0;
    return lights_[light].density * distance * distance / cosine;
}

double PathLights::environment_density() const {
    return environment_ / (4.0 * pi);
}

double PathLights::sun_disc(Direction direction, std::size_t k, std::span<double> radiance) const {
    const OneLight& light = lights_[suns_[k]];
    const auto& sun = std::get<radiosity::Sun>(e_.lights[light.index].source);
    const Direction apart = direction + glm::normalize(sun.direction);
    // |apart| = 2 sin(angle between / 2).
    if (glm::length(apart) > 2.0 * std::sin(0.25 * sun.angle)) return 0.0;
    for (std::size_t b = 0; b < e_.bands; ++b)
        radiance[b] += sun.irradiance[b] / disc_projected(sun);
    return light.density;
}

}  // namespace tyndall::render
