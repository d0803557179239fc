#include "radiosity/direct_light.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>

#include "mesh/visible_polygon.h"
#include "radiosity/closed_forms.h"
#include "radiosity/element_faces.h"
#include "radiosity/light_sources.h"
#include "radiosity/mean_transmittance.h"
#include "radiosity/mirrored_lights.h"
#include "radiosity/narrow_parts.h"
#include "radiosity/occlusion.h"
#include "radiosity/sampled_visibility.h"
#include "radiosity/shining_lights.h"

namespace tyndall::radiosity {
namespace {

using std::numbers::pi;
// Of the mesh's diagonal: above what rounding does to points computed on a plane.
constexpr double plane_rounding = 1e-10;
// Occluders × points beyond which none is tested for being an outer wall.
constexpr double most_wall_tests = 2e8;

struct LightScratch {
    mesh::VisibleScratch visible;
    std::vector<Point> relative, above;
    std::vector<double> mean;
};

// Drops walls with all that light can reach on one side of them: they come between no two points.
std::vector<mesh::ConvexPolygon> inner_polygons(const Enclosure& enclosure,
                                                const std::vector<mesh::ConvexPolygon>& all) {
    std::vector<bool> reached(enclosure.mesh.points.size(), false);
    for (std::size_t t = 0; t < enclosure.mesh.tets.size(); ++t)
        if (!enclosure.solid(TetId(t)))
            for (const auto corner : enclosure.mesh.tets[t]) reached[corner.value] = true;
    std::vector<Point> points;
    for (std::size_t k = 0; k < reached.size(); ++k)
        if (reached[k]) points.push_back(enclosure.mesh.points[k]);
    if (static_cast<double>(points.size()) * static_cast<double>(all.size()) > most_wall_tests)
        return all;
    const double tolerance = plane_rounding * diagonal(enclosure.mesh);
    std::vector<mesh::ConvexPolygon> inner;
    for (const auto& polygon : all) {
        bool front = false, back = false;
        for (const Point& p : points) {
            const double d = glm::dot(polygon.normal, p - polygon.corners[0]);
            front |= d > tolerance;
            back |= d < -tolerance;
            if (front && back) break;
        }
        if (front && back) inner.push_back(polygon);
    }
    return inner;
}

// Which side of a wall the receiver is on if it lies on one: towards the middle of its tet.
Direction into(const mesh::BaseMesh& mesh, const Receiver& receiver) {
    Point sum(0);
    for (const auto corner : mesh.tets[receiver.tet.value]) sum += mesh.points[corner.value];
    const Direction inside = 0.25 * sum - receiver.x;
    return receiver.on_surface && glm::dot(inside, receiver.normal) <= 0.0 ? receiver.normal
                                                                           : inside;
}

}  // namespace

struct DirectLight::Data {
    const Enclosure& enclosure;
    DirectLightOptions options;
    ShiningLights lights;
    mesh::Occluders inner;  // what can come between two points that light reaches
    mesh::Occluders all;    // and between such a point and infinity
    std::optional<Occlusion> occlusion;
    OpticalDepth depth;
    MirroredLights mirrored;
    Hull hull;
    double tolerance;  // [m]

    Data(const Enclosure& enclosure, const DirectLightOptions& options)
        : enclosure(enclosure),
          options(options),
          lights(shining_lights(enclosure, options.emitters, merge_tolerance)),
          depth(enclosure, merge_tolerance * diagonal(enclosure.mesh)),
          mirrored(enclosure),
          hull{enclosure.mesh.hull_min, enclosure.mesh.hull_max},
          tolerance(plane_rounding * diagonal(enclosure.mesh)) {
        if (lights.empty()) return;
        const auto polygons =
            occluding_polygons(enclosure, merge_tolerance * diagonal(enclosure.mesh));
        all = mesh::Occluders(polygons, tolerance);
        inner = mesh::Occluders(inner_polygons(enclosure, polygons), tolerance);
        if (!lights.areas.empty()) occlusion.emplace(enclosure.mesh);
    }

    void gather(const Receiver& receiver, std::span<double> incident) const;
    void visit(const Receiver& receiver, double widest, const ArrivingPart& visit) const;
    // What of an emitter the receiver sees; the whole emitter is left in scratch.relative, its
    // parts in scratch.visible.
    mesh::Visibility look(const Receiver& receiver, const AreaLight& light,
                          LightScratch& scratch) const;
    void from_area(const Receiver& receiver, const AreaLight& light, LightScratch& scratch,
                   std::span<double> incident) const;
    void from_part(const Receiver& receiver, const AreaLight& light, std::span<const Point> part,
                   LightScratch& scratch, std::span<double> incident) const;
    void from_samples(const Receiver& receiver, const AreaLight& light,
                      std::span<const Point> corners, LightScratch& scratch,
                      std::span<double> incident) const;
    void from_path(const Receiver& receiver, Direction path, mesh::Reach reach,
                   const Spectrum& strength, double factor, std::span<double> incident) const;
    double weight(const Receiver& receiver, std::span<const Point> corners) const;

    // on_path(path, reach, strength, factor) for every light without a size (2), (3).
    template <class OnPath>
    void for_paths(const Receiver& receiver, OnPath&& on_path) const {
        for (const Sun& sun : lights.beams)
            on_path(-sun.direction, mesh::Reach::infinite, sun.irradiance, 1.0);
        for (const PointLight& light : lights.points) {
            const Direction path = light.position - receiver.x;
            on_path(path, mesh::Reach::finite, light.intensity, 1.0 / glm::dot(path, path));
        }
        for (const SpotLight& light : lights.spots) {
            const Direction path = light.position - receiver.x;
            on_path(path, mesh::Reach::finite, light.intensity,
                    spot_share(light, -path) / glm::dot(path, path));
        }
    }
};

// Closed form of (1) for τ = 1 and unit radiance [-].
double DirectLight::Data::weight(const Receiver& receiver, std::span<const Point> corners) const {
    return receiver.on_surface ? projected_solid_angle(corners, receiver.normal) / pi
                               : solid_angle(corners) / (4.0 * pi);
}

void DirectLight::Data::from_part(const Receiver& receiver, const AreaLight& light,
                                  std::span<const Point> part, LightScratch& scratch,
                                  std::span<double> incident) const {
    const double share = weight(receiver, part);
    if (share == 0.0) return;
    mean_transmittance(depth, receiver, part,
                       light.reach == mesh::Reach::infinite ? &hull : nullptr, options.optical_step,
                       scratch.mean);
    for (std::size_t band = 0; band < incident.size(); ++band)
        incident[band] += light.radiance[band] * share * scratch.mean[band];  // (1)
}

void DirectLight::Data::from_samples(const Receiver& receiver, const AreaLight& light,
                                     std::span<const Point> corners, LightScratch& scratch,
                                     std::span<double> incident) const {
    sampled_transmittance(*occlusion, depth, receiver, corners,
                          light.reach == mesh::Reach::infinite ? &hull : nullptr,
                          options.shadow_rays, scratch.mean);
    const double share = weight(receiver, corners);
    for (std::size_t band = 0; band < incident.size(); ++band)
        incident[band] += light.radiance[band] * share * scratch.mean[band];
}

mesh::Visibility DirectLight::Data::look(const Receiver& receiver, const AreaLight& light,
                                         LightScratch& scratch) const {
    const bool finite = light.reach == mesh::Reach::finite;
    auto& corners = scratch.relative;
    corners.assign(light.corners.begin(), light.corners.end());
    if (finite) {
        for (Point& p : corners) p -= receiver.x;
        // Not in front of it.
        if (glm::dot(light.normal, corners[0]) >= -tolerance) return mesh::Visibility::none;
    }
    if (receiver.on_surface) {
        scratch.above.clear();
        mesh::clip(corners, receiver.normal, 0.0, scratch.above);
        corners.swap(scratch.above);
        if (corners.size() < 3) return mesh::Visibility::none;
    }
    const mesh::Target target{corners, light.reach, receiver.normal,
                              into(enclosure.mesh, receiver)};
    const mesh::VisibleLimits limits{options.exact_occluders};
    return (finite ? inner : all).look(receiver.x, target, limits, scratch.visible);
}

void DirectLight::Data::from_area(const Receiver& receiver, const AreaLight& light,
                                  LightScratch& scratch, std::span<double> incident) const {
    switch (look(receiver, light, scratch)) {
        case mesh::Visibility::none:
            return;
        case mesh::Visibility::too_many:
            return from_samples(receiver, light, scratch.relative, scratch, incident);
        case mesh::Visibility::all:
        case mesh::Visibility::part:
            for (std::size_t k = 0; k < scratch.visible.visible.size(); ++k)
                from_part(receiver, light, scratch.visible.visible[k], scratch, incident);
    }
}

// (2), (3): `factor` is all but strength, τ and visibility.
void DirectLight::Data::from_path(const Receiver& receiver, Direction path, mesh::Reach reach,
                                  const Spectrum& strength, double factor,
                                  std::span<double> incident) const {
    const double length = glm::length(path);
    if (length == 0.0 || factor <= 0.0) return;
    const double cosine = receiver.cosine(path / length);
    if (cosine <= 0.0) return;
    const Direction inside = into(enclosure.mesh, receiver);
    if (all.blocked(receiver.x, path, reach, inside)) return;
    thread_local std::vector<double> depths;
    depths.assign(incident.size(), 0.0);
    if (!depth.transparent()) {
        if (reach == mesh::Reach::infinite) path *= hull.exit(receiver.x, path);
        depth(receiver.x, receiver.tet, path, depths);
    }
    factor *= cosine / (receiver.on_surface ? pi : 4.0 * pi);
    for (std::size_t band = 0; band < incident.size(); ++band)
        incident[band] += strength[band] * factor * std::exp(-depths[band]);
}

void DirectLight::Data::gather(const Receiver& receiver, std::span<double> incident) const {
    assert(receiver.tet.valid() && incident.size() == enclosure.bands);
    std::fill(incident.begin(), incident.end(), 0.0);
    thread_local LightScratch scratch;
    scratch.mean.resize(incident.size());
    for (const AreaLight& light : lights.areas) from_area(receiver, light, scratch, incident);
    for_paths(receiver, [&](Direction path, mesh::Reach reach, const Spectrum& s, double factor) {
        from_path(receiver, path, reach, s, factor, incident);
    });
    if (!mirrored.empty()) mirrored.gather(receiver, incident);
}

void DirectLight::Data::visit(const Receiver& receiver, double widest,
                              const ArrivingPart& visit) const {
    thread_local LightScratch scratch;
    thread_local std::vector<double> part;
    scratch.mean.resize(enclosure.bands);
    const auto tell = [&](Direction towards, auto&& from) {
        part.assign(enclosure.bands, 0.0);
        from();
        if (!shines(part)) return;
        for (double& v : part) v *= 4.0 * pi;
        visit(glm::normalize(towards), part);
    };
    for (const AreaLight& light : lights.areas) {
        const auto visibility = look(receiver, light, scratch);
        if (visibility == mesh::Visibility::none) continue;
        const bool sampled = visibility == mesh::Visibility::too_many;
        const auto triangle = [&](const std::array<Point, 3>& corners) {
            tell(corners[0] + corners[1] + corners[2], [&] {
                if (sampled)
                    from_samples(receiver, light, corners, scratch, part);
                else
                    from_part(receiver, light, corners, scratch, part);
            });
        };
        if (sampled) {
            for_narrow_parts(scratch.relative, widest, triangle);
            continue;
        }
        for (std::size_t k = 0; k < scratch.visible.visible.size(); ++k)
            for_narrow_parts(scratch.visible.visible[k], widest, triangle);
    }
    for_paths(receiver, [&](Direction path, mesh::Reach reach, const Spectrum& s, double factor) {
        tell(path, [&] { from_path(receiver, path, reach, s, factor, part); });
    });
    if (!mirrored.empty()) mirrored.visit(receiver, visit);
}

DirectLight::DirectLight(const Enclosure& enclosure, const DirectLightOptions& options)
    : data_(std::make_unique<Data>(enclosure, options)) {}
DirectLight::~DirectLight() = default;
DirectLight::DirectLight(DirectLight&&) noexcept = default;
DirectLight& DirectLight::operator=(DirectLight&&) noexcept = default;

bool DirectLight::empty() const {
    return data_->lights.empty();
}

void DirectLight::at_zone(Point x, TetId tet, std::span<double> incident) const {
    const Direction none(0.0);
    if (!is_known(x, none, incident)) data_->gather({x, tet}, incident);
    if (keep_) keep_->keep(x, none, incident);
}

void DirectLight::visit_zone(Point x, TetId tet, double widest, const ArrivingPart& visit) const {
    data_->visit({x, tet}, widest, visit);
}

void DirectLight::at_patch(Point x, Direction n, TetId tet, std::span<double> incident) const {
    if (!is_known(x, n, incident)) data_->gather({x, tet, n, true}, incident);
    if (keep_) keep_->keep(x, n, incident);
}

void DirectLight::take_from(const PlaceMemory& known, const std::vector<mesh::Body>& moved) {
    known_ = &known;
    moved_ = moved;
    const auto& own = data_->enclosure.mesh.bodies;
    moved_.insert(moved_.end(), own.begin(), own.end());
}

bool DirectLight::is_known(Point x, Direction normal, std::span<double> incident) const {
    const double* known = known_ ? known_->find(x, normal) : nullptr;
    if (!known) return false;
    for (const LightCone& cone : data_->lights.cones)
        for (const mesh::Body& body : moved_)
            if (cone.passes(x, body)) return false;
    std::copy_n(known, incident.size(), incident.begin());
    return true;
}

bool DirectLight::cut_images() const {
    return data_->mirrored.cut();
}

const std::vector<LightPower>& DirectLight::powers() const {
    return data_->lights.powers;
}

}  // namespace tyndall::radiosity
