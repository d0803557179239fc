#include "radiosity/mirrored_ray.h"

#include <glm/geometric.hpp>

namespace tyndall::radiosity {

MirroredRay mirrored_ray(const mesh::BaseMesh& mesh, const mesh::Ray& ray,
                         const mesh::WalkEnd& struck) {
    const Direction n = mesh::normal(mesh, struck.facet);
    MirroredRay next;
    next.ray.origin = ray.origin + struck.distance * ray.direction;
    // Of unit length again: rounding would add up from mirror to mirror.
    next.ray.direction = glm::normalize(ray.direction - 2.0 * glm::dot(ray.direction, n) * n);
    next.ray.length = ray.length - struck.distance;
    next.start = mesh::start_on(mesh, struck.facet, struck.side);
    return next;
}

}  // namespace tyndall::radiosity
