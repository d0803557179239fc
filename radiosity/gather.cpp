#include "radiosity/gather.h"

#include <algorithm>
#include <cmath>

#include "radiosity/segment.h"

namespace tyndall::radiosity {
namespace {

constexpr double opaque_enough = 1e-9;  // transmittance below which nothing more is gained

}  // namespace

void radiance_along(const GatherScene& scene, const mesh::Ray& ray, mesh::WalkStart start,
                    std::span<double> radiance) {
    const std::size_t bands = radiance.size();
    const Enclosure& enclosure = scene.enclosure;
    std::fill(radiance.begin(), radiance.end(), 0.0);
    thread_local std::vector<double> transmittance;
    transmittance.assign(bands, 1.0);

    const auto on_zone = [&](const Spectrum& extinction, ZoneId zone, double t_in, double t_out) {
        double most = 0.0;
        for (std::size_t b = 0; b < bands; ++b) {
            const Affine& source = scene.sources.at(zone, b);
            const double at_origin = source.at(ray.origin);
            const double slope = glm::dot(source.gradient, ray.direction);
            const SegmentWeights w = segment_weights(extinction[b] * (t_out - t_in));
            // A linear fit may dip below zero in a corner; radiance does not.
            radiance[b] += transmittance[b] * (w.front * std::max(0.0, at_origin + t_in * slope) +
                                               w.back * std::max(0.0, at_origin + t_out * slope));
            transmittance[b] *= w.transmittance;
            most = std::max(most, transmittance[b]);
        }
        return most > opaque_enough;
    };
    const auto end =
        mesh::walk(enclosure.mesh, ray, start, [&](TetId tet, double t_in, double t_out) {
            const auto medium = enclosure.medium_of(tet);
            if (medium == none) return true;
            const Spectrum& extinction = enclosure.media[medium].extinction;
            return mesh::descend(
                scene.forest, mesh::root_zone(tet), ray, t_in, t_out,
                [&](ZoneId zone, double t) {
                    return scene.forest[zone].longest_edge < scene.detail * t;
                },
                [&](ZoneId zone, double s_in, double s_out) {
                    return on_zone(extinction, zone, s_in, s_out);
                });
        });
    if (end.arrival == mesh::Arrival::left) {
        for (std::size_t b = 0; b < bands; ++b)
            radiance[b] += transmittance[b] * enclosure.environment[b];
    } else if (end.arrival == mesh::Arrival::struck) {
        const Point x = ray.origin + end.distance * ray.direction;
        const PatchId leaf = scene.forest.leaf_at(mesh::root_patch(end.facet, end.side), x);
        for (std::size_t b = 0; b < bands; ++b)
            radiance[b] += transmittance[b] * std::max(0.0, scene.sources.at(leaf, b).at(x));
    }
}

void gather(const GatherScene& scene, const GatherPoint& point, const PointSet& points,
            std::uint64_t seed, std::span<Gathered> incident) {
    const std::size_t bands = incident.size();
    thread_local std::vector<double> radiance, halves;
    radiance.resize(bands);
    halves.assign(2 * bands, 0.0);
    for (std::size_t k = 0; k < points.size(); ++k) {
        const auto u = points(k, seed);
        mesh::Ray ray;
        ray.origin = point.x;
        ray.direction = point.on_surface() ? cosine_direction(point.normal, u[0], u[1])
                                           : uniform_direction(u[0], u[1]);
        radiance_along(scene, ray, point.start, radiance);
        double* half = halves.data() + (2 * k < points.size() ? 0 : bands);
        for (std::size_t b = 0; b < bands; ++b) half[b] += radiance[b];
    }
    const double count = static_cast<double>(points.size());
    for (std::size_t b = 0; b < bands; ++b) {
        incident[b].mean = (halves[b] + halves[bands + b]) / count;
        incident[b].spread = std::abs(halves[b] - halves[bands + b]) / count;
    }
}

}  // namespace tyndall::radiosity
