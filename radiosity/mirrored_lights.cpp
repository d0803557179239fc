#include "radiosity/mirrored_lights.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "radiosity/light_sources.h"
#include "radiosity/optical_depth.h"
#include "radiosity/point_set.h"

namespace tyndall::radiosity {
namespace {

using std::numbers::pi;

constexpr double same_plane = 1e-9;  // of the hull's diagonal, and between normals [-]
constexpr double least_weight = 1e-3;
constexpr double inwards = 1e-7;  // of the way to a tet's middle

// Directions to points of the sun's disc, of equal solid angles as far as it is small.
std::vector<Direction> towards(const Sun& sun) {
    const Direction d = -glm::normalize(sun.direction);
    if (!(sun.angle > 0.0)) return {d};
    const Direction other = std::abs(d.x) < 0.6 ? Direction(1, 0, 0) : Direction(0, 1, 0);
    const auto u = glm::normalize(glm::cross(other, d)), v = glm::cross(d, u);
    std::vector<Direction> result;
    constexpr double golden = std::numbers::phi - 1.0;
    for (std::size_t k = 0; k < MirroredLights::sun_points; ++k) {
        // A sunflower's seeds.
        const double radius = std::tan(0.5 * sun.angle) *
                              std::sqrt((double(k) + 0.5) / double(MirroredLights::sun_points));
        const double turn = 2.0 * pi * golden * double(k);
        result.push_back(glm::normalize(d + radius * (std::cos(turn) * u + std::sin(turn) * v)));
    }
    return result;
}

}  // namespace

MirroredLights::MirroredLights(const Enclosure& enclosure)
    : e_(enclosure),
      tolerance_(same_plane * glm::distance(enclosure.mesh.hull_min, enclosure.mesh.hull_max)) {
    if (e_.lights.empty() || !e_.has_mirrors()) return;
    find_planes();
    for (std::uint32_t k = 0; k < e_.lights.size(); ++k) {
        const auto& source = e_.lights[k].source;
        if (const auto* sun = std::get_if<Sun>(&source)) {
            const auto all = towards(*sun);
            for (const Direction& d : all) add_images(k, true, d, 1.0 / double(all.size()));
        } else if (const auto* point = std::get_if<PointLight>(&source)) {
            add_images(k, false, point->position, 1.0);
        } else if (const auto* spot = std::get_if<SpotLight>(&source)) {
            add_images(k, false, spot->position, 1.0);
        }
    }
}

void MirroredLights::find_planes() {
    const auto& mesh = e_.mesh;
    plane_of_.assign(2 * e_.facet_sides.size(), none);
    for (std::size_t f = 0; f < e_.facet_sides.size(); ++f)
        for (std::uint32_t back = 0; back < 2; ++back) {
            const auto side = e_.facet_sides[f][back];
            if (side == none || e_.sides[side].mirror.empty()) continue;
            const Direction n = (back ? -1.0 : 1.0) * mesh::normal(mesh, FacetId(f));
            const auto& corners = mesh.facets[f].corners;
            const double offset = glm::dot(n, mesh.points[corners[0].value]);
            auto plane = std::ranges::find_if(planes_, [&](const Plane& p) {
                return p.side == side && glm::distance(p.normal, n) < same_plane &&
                       std::abs(p.offset - offset) < tolerance_;
            });
            if (plane == planes_.end())
                plane = planes_.insert(planes_.end(),
                                       {n, offset, mesh.hull_max + 1.0, mesh.hull_min - 1.0, side});
            for (const auto corner : corners) {
                plane->low = glm::min(plane->low, mesh.points[corner.value] - tolerance_);
                plane->high = glm::max(plane->high, mesh.points[corner.value] + tolerance_);
            }
            plane_of_[2 * f + back] = static_cast<std::uint32_t>(plane - planes_.begin());
        }
}

bool MirroredLights::faces(const Plane& plane, bool infinite, Point at) const {
    const double height = glm::dot(plane.normal, at);
    return infinite ? height > same_plane : height - plane.offset > tolerance_;
}

// Images of images, order by order.
void MirroredLights::add_images(std::uint32_t light, bool infinite, Point at, double share) {
    struct Open {
        Point at;
        std::vector<std::uint32_t> planes;  // the last first
        double weight;
    };
    std::vector<Open> order{{at, {}, 1.0}};
    while (!order.empty()) {
        std::vector<Open> next;
        for (const Open& from : order)
            for (std::uint32_t p = 0; p < planes_.size(); ++p) {
                const Plane& plane = planes_[p];
                if (!faces(plane, infinite, from.at)) continue;
                const double weight =
                    from.weight * *std::ranges::max_element(e_.sides[plane.side].mirror);
                if (!(weight > least_weight)) continue;
                if (images_.size() == most_images) {
                    cut_ = true;
                    return;
                }
                const double height =
                    glm::dot(plane.normal, from.at) - (infinite ? 0.0 : plane.offset);
                Open image{from.at - 2.0 * height * plane.normal, {p}, weight};
                image.planes.insert(image.planes.end(), from.planes.begin(), from.planes.end());
                const auto begin = static_cast<std::uint32_t>(planes_met_.size());
                planes_met_.insert(planes_met_.end(), image.planes.begin(), image.planes.end());
                images_.push_back({light, infinite, image.at, share, begin,
                                   static_cast<std::uint32_t>(planes_met_.size())});
                next.push_back(std::move(image));
            }
        order = std::move(next);
    }
}

bool MirroredLights::meets(const Plane& plane, const mesh::Ray& ray) const {
    const double height = glm::dot(plane.normal, ray.origin) - plane.offset;
    const double fall = -glm::dot(plane.normal, ray.direction);
    if (!(height > -tolerance_) || !(fall > 0.0)) return false;
    const Point x = ray.origin + height / fall * ray.direction;
    for (int axis = 0; axis < 3; ++axis)
        if (x[axis] < plane.low[axis] - tolerance_ || x[axis] > plane.high[axis] + tolerance_)
            return false;
    return true;
}

bool MirroredLights::follow(const Image& image, mesh::Ray ray, mesh::WalkStart start,
                            std::span<double> irradiance) const {
    thread_local std::vector<double> depth;
    depth.assign(irradiance.size(), 0.0);
    std::ranges::fill(irradiance, image.share);
    for (std::uint32_t k = image.begin;; ++k) {
        const auto end = mesh::walk(e_.mesh, ray, start, [&](TetId tet, double t_in, double t_out) {
            add_depth(e_, tet, ray, t_in, t_out, depth);
            return true;
        });
        if (k == image.end) {
            if (end.arrival != (image.infinite ? mesh::Arrival::left : mesh::Arrival::ended))
                return false;
            break;
        }
        const SurfaceSide* mirror = mirror_struck(e_, end);
        if (!mirror || plane_of_[2 * end.facet.value + (end.side == Side::back)] != planes_met_[k])
            return false;
        for (std::size_t b = 0; b < irradiance.size(); ++b) irradiance[b] *= mirror->mirror[b];
        const MirroredRay next = mirrored_ray(e_.mesh, ray, end);
        ray = next.ray;
        start = next.start;
    }
    const auto& source = e_.lights[image.light].source;
    const auto* spot = std::get_if<SpotLight>(&source);
    const double share = spot ? spot_share(*spot, -ray.direction) : 1.0;
    const Spectrum& strength = std::visit(
        [](const auto& light) -> const Spectrum& {
            if constexpr (requires { light.irradiance; })
                return light.irradiance;
            else
                return light.intensity;
        },
        source);
    for (std::size_t b = 0; b < irradiance.size(); ++b)
        irradiance[b] *= share * strength[b] * std::exp(-depth[b]);
    return share > 0.0;
}

void MirroredLights::visit(const Receiver& receiver, const Visit& visit) const {
    thread_local std::vector<double> irradiance;
    // A place on a mirror is moved off it: nothing then hangs on which face it lies on.
    Point middle(0.0);
    for (const auto corner : e_.mesh.tets[receiver.tet.value])
        middle += 0.25 * e_.mesh.points[corner.value];
    const Point x = receiver.x + inwards * (middle - receiver.x);
    for (const Image& image : images_) {
        mesh::Ray ray{x, image.at};
        double distance = 1.0;
        if (!image.infinite) {
            distance = glm::distance(image.at, x);
            if (distance == 0.0) continue;
            ray.direction = (image.at - x) / distance;
            ray.length = distance * (1.0 - same_plane);
        }
        if (!(receiver.cosine(ray.direction) > 0.0) ||
            !meets(planes_[planes_met_[image.begin]], ray))
            continue;
        irradiance.resize(e_.bands);
        if (!follow(image, ray, {receiver.tet}, irradiance)) continue;
        for (double& value : irradiance) value /= distance * distance;
        visit(ray.direction, irradiance);
    }
}

void MirroredLights::gather(const Receiver& receiver, std::span<double> incident) const {
    visit(receiver, [&](Direction towards, std::span<const double> irradiance) {
        const double factor =
            receiver.on_surface ? receiver.cosine(towards) / pi : 1.0 / (4.0 * pi);
        for (std::size_t b = 0; b < incident.size(); ++b) incident[b] += factor * irradiance[b];
    });
}

}  // namespace tyndall::radiosity
