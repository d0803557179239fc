// The slow, obvious picture of direct and single-scattered light: small steps along every ray,
// direct light with exact visibility at each. The oracle of pictures made from a mesh.
#pragma once

#include <tbb/parallel_for.h>

#include <cmath>

#include "radiosity/direct_light.h"
#include "radiosity/elements.h"
#include "radiosity/point_set.h"
#include "render/camera.h"
#include "render/image.h"

namespace tyndall::test {

// Equation: L = Σ_k T(s_k) κ Ω H(s_k) Δs + T(s_end) ρ H, at the rays of a picture made with these
//   options (one seed, one set of points), so that only the elements differ. A step that crosses a
//   shadow's edge is off by half of itself at most.
// Valid for: an eye inside the mesh; media without emission, no environment; one band.
// Cost: width × height × samples × length / step evaluations of direct light.
inline render::Layer marched_picture(const radiosity::Enclosure& enclosure,
                                     const render::Camera& camera, std::size_t samples, double step,
                                     std::uint64_t seed = 1) {
    const radiosity::DirectLight light(enclosure);
    const mesh::TetId eye = mesh::locate(enclosure.mesh, camera.eye);
    const radiosity::PointSet points(samples);
    render::Layer layer{"direct_single", 1, std::vector<float>(camera.width * camera.height)};
    const auto look = [&](const mesh::Ray& ray) {
        double radiance = 0.0, transmittance = 1.0, h = 0.0;
        const auto end =
            mesh::walk(enclosure.mesh, ray, {eye}, [&](mesh::TetId tet, double t_in, double t_out) {
                const auto medium = enclosure.medium_of(tet);
                if (medium == radiosity::none || enclosure.solid(tet)) return true;
                const auto& optics = enclosure.media[medium];
                const double steps = std::ceil((t_out - t_in) / step);
                const double length = (t_out - t_in) / steps;
                const double kept = std::exp(-optics.extinction[0] * length);
                for (double k = 0.0; k < steps; ++k) {
                    light.at_zone(ray.origin + (t_in + (k + 0.5) * length) * ray.direction, tet,
                                  {&h, 1});
                    radiance += transmittance * (1.0 - kept) * optics.albedo[0] * h;
                    transmittance *= kept;
                }
                return true;
            });
        if (end.arrival != mesh::Arrival::struck) return radiance;
        const bool back = end.side == mesh::Side::back;
        const auto side = enclosure.facet_sides[end.facet.value][back];
        if (side == radiosity::none) return radiance;
        const mesh::Direction normal = mesh::normal(enclosure.mesh, end.facet);
        light.at_patch(ray.origin + end.distance * ray.direction, back ? -normal : normal, end.tet,
                       {&h, 1});
        const auto& optics = enclosure.sides[side];
        return radiance + transmittance * (optics.emission[0] + optics.reflectance[0] * h);
    };
    const render::CameraRays camera_ray(camera);
    tbb::parallel_for(std::size_t(0), layer.values.size(), [&](std::size_t pixel) {
        double sum = 0.0;
        for (std::size_t k = 0; k < points.size(); ++k) {
            const auto u = points(k, radiosity::hash_seed(seed, pixel));
            sum += look(camera_ray(double(pixel % camera.width) + u[0],
                                   double(pixel / camera.width) + u[1]));
        }
        layer.values[pixel] = static_cast<float>(sum / double(points.size()));
    });
    return layer;
}

}  // namespace tyndall::test
