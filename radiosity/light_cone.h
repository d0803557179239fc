// Whether a body may come between a point and a light.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "mesh/base_mesh.h"
#include "radiosity/scene.h"

namespace tyndall::radiosity {

// Where a light is, as far as a body can come between: a sphere, or a cone of directions.
struct LightCone {
    bool infinite = false;
    Point centre{0};          // [m]
    double radius = 0.0;      // [m]
    Direction towards{0};     // unit, of an infinite one
    double half_angle = 0.0;  // of its cone [rad]

    // Whether a body's sphere meets the cone from x over the light.
    bool passes(Point x, const mesh::Body& body) const {
        const Direction to = body.centre - x;
        const double far = glm::length(to);
        if (far <= body.radius) return true;
        const double wide = std::asin(body.radius / far);
        if (infinite)
            return std::acos(std::clamp(glm::dot(to, towards) / far, -1.0, 1.0)) <=
                   wide + half_angle + 1e-7;
        const Direction light = centre - x;
        const double distance = glm::length(light);
        if (distance <= radius) return true;
        if (far - body.radius > distance + radius) return false;
        const double cosine = glm::dot(to, light) / (far * distance);
        return std::acos(std::clamp(cosine, -1.0, 1.0)) <=
               wide + std::asin(radius / distance) + 1e-7;
    }
};

}  // namespace tyndall::radiosity
