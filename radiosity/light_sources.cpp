#include "radiosity/light_sources.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "radiosity/closed_forms.h"

namespace tyndall::radiosity {
namespace {

constexpr int sun_corners = 32;  // the disc's rim departs from a circle by 0.3 % of its radius
using std::numbers::pi;

double share_at(const SpotLight& spot, double theta) {
    const double t = theta - 0.5 * spot.angle;
    if (t <= 0.0) return 1.0;
    if (t >= spot.soft_edge) return 0.0;
    const double u = t / spot.soft_edge;
    return 1.0 - u * u * (3.0 - 2.0 * u);
}

std::vector<Point> regular(Direction centre, double radius) {
    const Direction axis = std::abs(centre.x) < 0.6 ? Direction(1, 0, 0) : Direction(0, 1, 0);
    const Direction u = glm::normalize(glm::cross(axis, centre)), v = glm::cross(u, centre);
    std::vector<Point> corners;
    for (int k = 0; k < sun_corners; ++k) {
        const double phi = 2.0 * pi * k / sun_corners;
        corners.push_back(centre + radius * (std::cos(phi) * u + std::sin(phi) * v));
    }
    return corners;
}

}  // namespace

double spot_share(const SpotLight& spot, Direction omega) {
    const Direction axis = glm::normalize(spot.direction);
    return share_at(spot, std::atan2(glm::length(glm::cross(axis, omega)), glm::dot(axis, omega)));
}

double spot_solid_angle(const SpotLight& spot) {
    const double inner = std::min(0.5 * spot.angle, pi);
    const double outer = std::min(inner + spot.soft_edge, pi);
    double edge = 0.0;  // composite Simpson's rule: smooth integrand, error below 1e-9
    constexpr int steps = 128;
    const double h = (outer - inner) / steps;
    for (int k = 0; k <= steps; ++k) {
        const double weight = k == 0 || k == steps ? 1.0 : k % 2 ? 4.0 : 2.0;
        const double theta = inner + h * k;
        edge += weight * h / 3.0 * share_at(spot, theta) * std::sin(theta);
    }
    return 2.0 * pi * (1.0 - std::cos(inner) + edge);
}

std::vector<Point> sun_disc(const Sun& sun) {
    const Direction centre = -glm::normalize(sun.direction);
    const double half = 0.5 * sun.angle;
    const double wanted = 4.0 * pi * std::pow(std::sin(0.5 * half), 2);  // 2π (1 − cos)
    // The polygon's solid angle grows with its radius: a few secant steps on the ratio suffice.
    double radius = std::tan(half);
    for (int step = 0; step < 20; ++step)
        radius *= std::sqrt(wanted / solid_angle(regular(centre, radius)));
    return regular(centre, radius);
}

}  // namespace tyndall::radiosity
