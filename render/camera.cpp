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
using radiosity::PictureProjection;

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

// The one of two lengths or angles that is given, by its half.
double half_of(const Camera& camera, const std::optional<double>& x, const std::optional<double>& y,
               std::string_view name) {
    if (x.has_value() == y.has_value())
        throw InputError(
            fmt::format("camera '{}': {} of {}_x and {}_y are given. Give exactly one.",
                        camera.name, x ? "both" : "none", name, name));
    return 0.5 * (x ? *x : *y);
}

double tan_half(const Camera& camera) {
    const double half = half_of(camera, camera.fov_x, camera.fov_y, "fov");
    if (!(half > 0.0 && half < 0.5 * std::numbers::pi))
        throw InputError(
            fmt::format("camera '{}': a field of view of {}° is impossible. Give more than 0° and "
                        "less than 180°.",
                        camera.name, half * 360.0 / std::numbers::pi));
    return std::tan(half);
}

double half_extent(const Camera& camera) {
    const double half = half_of(camera, camera.extent_x, camera.extent_y, "extent");
    if (!(half > 0.0 && std::isfinite(half)))
        throw InputError(
            fmt::format("camera '{}': an extent of {} m is impossible. Give more than 0 m.",
                        camera.name, 2.0 * half));
    return half;
}

void check_lens(const Camera& camera) {
    if (!camera.lens) return;
    if (camera.projection != PictureProjection::perspective)
        throw InputError(
            fmt::format("camera '{}': only a perspective picture is made by a lens. Leave it out.",
                        camera.name));
    if (!(camera.lens->diameter >= 0.0 && camera.lens->focus > 0.0 &&
          std::isfinite(camera.lens->diameter + camera.lens->focus)))
        throw InputError(fmt::format(
            "camera '{}': a lens of {} m that is focused at {} m is impossible. Give a diameter of "
            "at least 0 m and a focus above 0 m.",
            camera.name, camera.lens->diameter, camera.lens->focus));
}

// Half of the picture's width and height as View has them; `aspect`: width over height.
std::pair<double, double> halves(const Camera& camera, double aspect) {
    switch (camera.projection) {
        case PictureProjection::perspective:
            break;
        case PictureProjection::orthographic: {
            const double half = half_extent(camera);
            return camera.extent_x ? std::pair(half, half / aspect)
                                   : std::pair(half * aspect, half);
        }
        case PictureProjection::panorama:
            if (aspect != 2.0)
                throw InputError(fmt::format(
                    "camera '{}': a panorama is twice as wide as high, for 360° by 180°. Give such "
                    "a width and height.",
                    camera.name));
            return {std::numbers::pi, 0.5 * std::numbers::pi};
    }
    const double half = tan_half(camera);
    return camera.fov_x ? std::pair(half, half / aspect) : std::pair(half * aspect, half);
}

// From the unit square to the disc of radius 1, areas in proportion, neighbours kept.
glm::dvec2 concentric_disc(glm::dvec2 u) {
    const double a = 2.0 * u.x - 1.0, b = 2.0 * u.y - 1.0;
    if (a == 0.0 && b == 0.0) return {0.0, 0.0};
    const bool wide = std::abs(a) > std::abs(b);
    const double radius = wide ? a : b;
    const double angle = wide ? 0.25 * std::numbers::pi * (b / a)
                              : 0.5 * std::numbers::pi - 0.25 * std::numbers::pi * (a / b);
    return radius * glm::dvec2(std::cos(angle), std::sin(angle));
}

}  // namespace

radiosity::View Camera::view() const {
    check_vectors(*this);
    check_lens(*this);
    const Direction forward = glm::normalize(target - eye);
    const Direction across = glm::cross(forward, up);
    // Below 1e-9 the roll of the picture would be decided by rounding.
    if (!(glm::length(across) > 1e-9 * glm::length(up)))
        throw InputError(
            fmt::format("camera '{}': up {} is zero or parallel to the view from {} to "
                        "{}. Give another up.",
                        name, text(up), text(eye), text(target)));
    const Direction right = glm::normalize(across);
    const auto [half_x, half_y] =
        halves(*this, static_cast<double>(whole_width ? whole_width : width) /
                          static_cast<double>(whole_height ? whole_height : height));
    // A panorama's horizon is level, wherever its middle is.
    if (projection == PictureProjection::panorama) {
        const Direction zenith = glm::normalize(up);
        return {projection, eye, glm::cross(zenith, right), right, zenith, half_x, half_y};
    }
    return {projection, eye, forward, right, glm::cross(right, forward), half_x, half_y};
}

Camera Camera::cropped(std::size_t from_left, std::size_t from_top, std::size_t columns,
                       std::size_t rows) const {
    if (columns == 0 || rows == 0 || from_left >= width || columns > width - from_left ||
        from_top >= height || rows > height - from_top)
        throw InputError(fmt::format(
            "camera '{}': there are no {} × {} pixels from pixel ({}, {}) of a picture of {} × {}. "
            "Give a part of it.",
            name, columns, rows, from_left, from_top, width, height));
    Camera part = *this;
    part.whole_width = whole_width ? whole_width : width;
    part.whole_height = whole_height ? whole_height : height;
    part.left += from_left;
    part.top += from_top;
    part.width = columns;
    part.height = rows;
    return part;
}

mesh::Ray Camera::ray(double x, double y) const {
    return CameraRays(*this)(x, y);
}

CameraRays::CameraRays(const Camera& camera)
    : frame_(camera.view()),
      lens_(camera.lens && camera.lens->diameter > 0.0 ? camera.lens : std::nullopt),
      left_(static_cast<double>(camera.left)),
      top_(static_cast<double>(camera.top)),
      width_(static_cast<double>(camera.whole_width ? camera.whole_width : camera.width)),
      height_(static_cast<double>(camera.whole_height ? camera.whole_height : camera.height)) {}

mesh::Ray CameraRays::operator()(double x, double y, glm::dvec2 lens) const {
    const mesh::Ray pinhole =
        frame_.ray(2.0 * (left_ + x) / width_ - 1.0, 1.0 - 2.0 * (top_ + y) / height_);
    if (!lens_) return pinhole;
    const double along = glm::dot(pinhole.direction, frame_.forward);
    const mesh::Point sharp = frame_.eye + lens_->focus / along * pinhole.direction;
    const glm::dvec2 place = 0.5 * lens_->diameter * concentric_disc(lens);
    const mesh::Point origin = frame_.eye + place.x * frame_.right + place.y * frame_.up;
    return {origin, glm::normalize(sharp - origin)};
}

}  // namespace tyndall::render
