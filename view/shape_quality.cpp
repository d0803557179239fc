#include "view/shape_quality.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tyndall::view {
namespace {

template <std::size_t size>
double squared_edges(const std::array<mesh::Point, size>& p) {
    double sum = 0.0;
    for (std::size_t i = 0; i < size; ++i)
        for (std::size_t j = i + 1; j < size; ++j) sum += glm::dot(p[i] - p[j], p[i] - p[j]);
    return sum;
}

double area_of(mesh::Point a, mesh::Point b, mesh::Point c) {
    return 0.5 * glm::length(glm::cross(b - a, c - a));
}

double volume_of(const std::array<mesh::Point, 4>& p) {
    return std::abs(glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0])) / 6.0;
}

// (a+b−c)(a+c−b)(b+c−a): 0 where the three lengths make no triangle.
double excesses(double a, double b, double c) {
    return std::max(0.0, a + b - c) * std::max(0.0, a + c - b) * std::max(0.0, b + c - a);
}

}  // namespace

double mean_ratio(const std::array<mesh::Point, 4>& p) {
    const double volume = volume_of(p), edges = squared_edges(p);
    return edges > 0.0 ? 12.0 * std::cbrt(9.0 * volume * volume) / edges : 0.0;
}

double mean_ratio(const std::array<mesh::Point, 3>& p) {
    const double edges = squared_edges(p);
    return edges > 0.0 ? 4.0 * std::sqrt(3.0) * area_of(p[0], p[1], p[2]) / edges : 0.0;
}

double radius_ratio(const std::array<mesh::Point, 4>& p) {
    const double volume = volume_of(p);
    const double faces = area_of(p[0], p[1], p[2]) + area_of(p[0], p[1], p[3]) +
                         area_of(p[0], p[2], p[3]) + area_of(p[1], p[2], p[3]);
    const auto product = [&](int i, int j, int k, int l) {
        return glm::distance(p[i], p[j]) * glm::distance(p[k], p[l]);
    };
    const double a = product(0, 1, 2, 3), b = product(0, 2, 1, 3), c = product(0, 3, 1, 2);
    const double root = std::sqrt((a + b + c) * excesses(a, b, c));
    return faces * root > 0.0 ? 216.0 * volume * volume / (faces * root) : 0.0;
}

double radius_ratio(const std::array<mesh::Point, 3>& p) {
    const double a = glm::distance(p[1], p[2]), b = glm::distance(p[2], p[0]),
                 c = glm::distance(p[0], p[1]);
    return a * b * c > 0.0 ? excesses(a, b, c) / (a * b * c) : 0.0;
}

}  // namespace tyndall::view
