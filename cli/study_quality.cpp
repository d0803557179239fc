#include "cli/study_quality.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tyndall::cli {
namespace {

template <std::size_t size>
double squared_edges(const std::array<mesh::Point, size>& p) {
    double sum = 0.0;
    for (std::size_t i = 0; i < size; ++i)
        for (std::size_t j = i + 1; j < size; ++j) sum += glm::dot(p[i] - p[j], p[i] - p[j]);
    return sum;
}

template <std::size_t size, class Node>
void measure(const mesh::Forest& forest, const std::vector<Node>& nodes, double& least,
             double& mean) {
    double sum = 0.0;
    for (const Node node : nodes) {
        std::array<mesh::Point, size> corners;
        for (std::size_t k = 0; k < size; ++k) corners[k] = forest.point(forest[node].corners[k]);
        const double quality = mean_ratio(corners);
        least = std::min(least, quality);
        sum += quality;
    }
    if (!nodes.empty()) mean = sum / static_cast<double>(nodes.size());
}

}  // namespace

double mean_ratio(const std::array<mesh::Point, 4>& p) {
    const double volume =
        std::abs(glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0])) / 6.0;
    const double edges = squared_edges(p);
    return edges > 0.0 ? 12.0 * std::cbrt(9.0 * volume * volume) / edges : 0.0;
}

double mean_ratio(const std::array<mesh::Point, 3>& p) {
    const double area = 0.5 * glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
    const double edges = squared_edges(p);
    return edges > 0.0 ? 4.0 * std::sqrt(3.0) * area / edges : 0.0;
}

ElementQuality element_quality(const radiosity::Solution& solution) {
    const auto elements = radiosity::elements_of_leaves(*solution.enclosure, solution.forest);
    ElementQuality quality;
    measure<4>(solution.forest, elements.zones, quality.tet_min, quality.tet_mean);
    measure<3>(solution.forest, elements.patches, quality.triangle_min, quality.triangle_mean);
    return quality;
}

}  // namespace tyndall::cli
