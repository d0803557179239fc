#include "render/camera.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "mesh/input_error.h"

namespace tyndall::render {

namespace {

using mesh::Direction;
using mesh::InputError;

bool finite(const Direction& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

std::string text(const Direction& v) {
    return fmt::format("({}, {}, {})", v.x, v.y, v.z);
}

void check_vectors(const Camera& camera) {
    if (!finite(camera.eye) || !finite(camera.target) || !finite(camera.up))
        throw InputError(fmt::format(
            "camera '{}': eye {}, target {} and up {} must be finite numbers. Correct them.",
            camera.name, text(camera.eye), text(camera.target), text(camera.up)));
    if (camera.eye == camera.target)
        throw InputError(
            fmt::format("camera '{}': eye and target coincide at {}. Move one of them.",
                        camera.name, text(camera.eye)));
    if (camera.width == 0 || camera.height == 0)
        throw InputError(
            fmt::format("camera '{}': a picture of {} × {} pixels is empty. Give width "
                        "and height of at least 1.",
                        camera.name, camera.width, camera.height));
}

// tan of half the one angle that is given.
double tan_half(const Camera& camera) {
    if (camera.fov_x.has_value() == camera.fov_y.has_value())
        throw InputError(
            fmt::format("camera '{}': {} of fov_x and fov_y are given. Give exactly one.",
                        camera.name, camera.fov_x ? "both" : "none"));
    const double angle = camera.fov_x ? *camera.fov_x : *camera.fov_y;
    if (!(angle > 0.0 && angle < std::numbers::pi))
        throw InputError(
            fmt::format("camera '{}': a field of view of {}° is impossible. Give more than 0° and "
                        "less than 180°.",
                        camera.name, angle * 180.0 / std::numbers::pi));
    return std::tan(0.5 * angle);
}

}  // namespace

radiosity::View Camera::view() const {
    check_vectors(*this);
    const double given = tan_half(*this);
    const Direction forward = glm::normalize(target - eye);
    const Direction across = glm::cross(forward, up);
    // Below 1e-9 the roll of the picture would be decided by rounding.
    if (!(glm::length(across) > 1e-9 * glm::length(up)))
        throw InputError(
            fmt::format("camera '{}': up {} is zero or parallel to the view from {} to "
                        "{}. Give another up.",
                        name, text(up), text(eye), text(target)));
    const Direction right = glm::normalize(across);
    const double aspect = static_cast<double>(width) / static_cast<double>(height);
    return {.eye = eye,
            .forward = forward,
            .right = right,
            .up = glm::cross(right, forward),
            .tan_half_x = fov_x ? given : given * aspect,
            .tan_half_y = fov_y ? given : given / aspect};
}

mesh::Ray Camera::ray(double x, double y) const {
    return CameraRays(*this)(x, y);
}

CameraRays::CameraRays(const Camera& camera)
    : frame_(camera.view()),
      width_(static_cast<double>(camera.width)),
      height_(static_cast<double>(camera.height)) {}

mesh::Ray CameraRays::operator()(double x, double y) const {
    const double s = (2.0 * x / width_ - 1.0) * frame_.tan_half_x;
    const double t = (1.0 - 2.0 * y / height_) * frame_.tan_half_y;
    return {.origin = frame_.eye,
            .direction = glm::normalize(frame_.forward + s * frame_.right + t * frame_.up)};
}

}  // namespace tyndall::render
