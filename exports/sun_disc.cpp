#include "exports/sun_disc.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace tyndall::exports {

constexpr double rooms_away = 1e4;

SunDisc sun_disc(const radiosity::Sun& sun, mesh::Point centre, double size) {
    const double half = 0.5 * sun.angle, distance = rooms_away * size;
    SunDisc disc{centre - distance * glm::normalize(sun.direction),
                 across(sun.direction),
                 distance * std::tan(half),
                 {}};
    for (const double irradiance : sun.irradiance)
        disc.radiance.push_back(irradiance / (std::numbers::pi * std::pow(std::sin(half), 2)));
    return disc;
}

mesh::Direction across(mesh::Direction direction) {
    const auto d = glm::abs(direction);
    const mesh::Direction axis = d.x <= d.y && d.x <= d.z ? mesh::Direction(1, 0, 0)
                                 : d.y <= d.z             ? mesh::Direction(0, 1, 0)
                                                          : mesh::Direction(0, 0, 1);
    return glm::normalize(glm::cross(direction, axis));
}

}  // namespace tyndall::exports
