#include "radiosity/closed_forms.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace tyndall::radiosity {

double solid_angle(std::span<const mesh::Point> corners) {
    if (corners.size() < 3) return 0.0;
    const mesh::Point& a = corners[0];
    const double la = glm::length(a);
    mesh::Point b = corners[1];
    double lb = glm::length(b), sum = 0.0;
    for (std::size_t k = 2; k < corners.size(); ++k) {
        const mesh::Point& c = corners[k];
        const double lc = glm::length(c);
        // Differences keep the digits of a small polygon far away.
        const double volume = glm::dot(a, glm::cross(b - a, c - a));
        sum += std::atan2(
            volume, la * lb * lc + la * glm::dot(b, c) + lb * glm::dot(c, a) + lc * glm::dot(a, b));
        b = c;
        lb = lc;
    }
    return 2.0 * std::abs(sum);
}

double projected_solid_angle(std::span<const mesh::Point> corners, mesh::Direction n) {
    double sum = 0.0;
    for (std::size_t k = 0, count = corners.size(); k < count; ++k) {
        const mesh::Point& a = corners[k];
        const mesh::Point& b = corners[k + 1 == count ? 0 : k + 1];
        const mesh::Direction m = glm::cross(a, b - a);
        const double length = glm::length(m);
        if (length > 0.0) sum += std::atan2(length, glm::dot(a, b)) * glm::dot(m, n) / length;
    }
    return 0.5 * std::abs(sum);
}

}  // namespace tyndall::radiosity
