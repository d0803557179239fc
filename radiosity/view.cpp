#include "radiosity/view.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace tyndall::radiosity {

using mesh::Direction;
using mesh::Point;

mesh::Ray View::ray(double s, double t) const {
    const double x = s * half_x, y = t * half_y;
    switch (projection) {
        case PictureProjection::perspective:
            break;
        case PictureProjection::orthographic:
            return {eye + x * right + y * up, forward};
        case PictureProjection::panorama:
            return {eye,
                    std::cos(y) * (std::cos(x) * forward + std::sin(x) * right) + std::sin(y) * up};
    }
    return {eye, glm::normalize(forward + x * right + y * up)};
}

double View::extent() const {
    switch (projection) {
        case PictureProjection::perspective:
            break;
        case PictureProjection::orthographic:
            return 4.0 * half_x * half_y;
        case PictureProjection::panorama:
            return 4.0 * std::numbers::pi;
    }
    const double a = half_x, b = half_y;
    return 4.0 * std::asin(a * b / std::sqrt((1.0 + a * a) * (1.0 + b * b)));
}

bool View::sees(Point centre, double radius) const {
    if (projection == PictureProjection::panorama) return true;
    const Direction d = centre - eye;
    const double z = glm::dot(d, forward);
    if (z < -radius) return false;
    const double x = std::abs(glm::dot(d, right)), y = std::abs(glm::dot(d, up));
    const double a = half_x, b = half_y;
    if (projection == PictureProjection::orthographic) return x <= a + radius && y <= b + radius;
    return x <= z * a + radius * std::sqrt(1.0 + a * a) &&
           y <= z * b + radius * std::sqrt(1.0 + b * b);
}

double View::covered(Point centre, double projected, double size) const {
    if (projection == PictureProjection::orthographic) return projected;
    const double distance = std::max(glm::length(centre - eye), size);
    return projected / (distance * distance);
}

Direction View::direction_to(Point x) const {
    if (projection == PictureProjection::orthographic) return forward;
    const Direction d = x - eye;
    return d / std::max(glm::length(d), 1e-12);
}

double View::distance_to(Point x) const {
    if (projection == PictureProjection::orthographic) return glm::dot(x - eye, forward);
    return glm::length(x - eye);
}

}  // namespace tyndall::radiosity
