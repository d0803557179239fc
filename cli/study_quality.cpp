#include "cli/study_quality.h"

#include <algorithm>

#include "view/shape_quality.h"

namespace tyndall::cli {
namespace {

template <std::size_t size, class Node>
void measure(const mesh::Forest& forest, const std::vector<Node>& nodes, double& least,
             double& mean) {
    double sum = 0.0;
    for (const Node node : nodes) {
        std::array<mesh::Point, size> corners;
        for (std::size_t k = 0; k < size; ++k) corners[k] = forest.point(forest[node].corners[k]);
        const double quality = view::mean_ratio(corners);
        least = std::min(least, quality);
        sum += quality;
    }
    if (!nodes.empty()) mean = sum / static_cast<double>(nodes.size());
}

}  // namespace

ElementQuality element_quality(const radiosity::Solution& solution) {
    const auto elements = radiosity::elements_of_leaves(*solution.enclosure, solution.forest);
    ElementQuality quality;
    measure<4>(solution.forest, elements.zones, quality.tet_min, quality.tet_mean);
    measure<3>(solution.forest, elements.patches, quality.triangle_min, quality.triangle_mean);
    return quality;
}

}  // namespace tyndall::cli
