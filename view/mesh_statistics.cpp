#include "view/mesh_statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "view/shape_quality.h"

namespace tyndall::view {
namespace {

using radiosity::Solution;

template <std::size_t size, class Node>
std::array<mesh::Point, size> corners_of(const mesh::Forest& forest, Node node) {
    std::array<mesh::Point, size> corners;
    for (std::size_t k = 0; k < size; ++k) corners[k] = forest.point(forest[node].corners[k]);
    return corners;
}

double thickness(const Solution& s, mesh::ZoneId zone, double volume) {
    double extinction = 0.0;
    for (std::size_t b = 0; b < s.enclosure->bands; ++b)
        extinction =
            std::max(extinction, radiosity::extinction_in(*s.enclosure, s.forest, zone, b).mean);
    return extinction * std::cbrt(volume);
}

}  // namespace

MeshStatistics mesh_statistics(const Solution& s) {
    const auto leaves = radiosity::elements_of_leaves(*s.enclosure, s.forest);
    MeshStatistics m;
    for (const mesh::PatchId patch : leaves.patches) {
        const auto corners = corners_of<3>(s.forest, patch);
        m.patch_area.push_back(s.forest.area(patch));
        m.patch_radius_ratio.push_back(radius_ratio(corners));
        m.patch_mean_ratio.push_back(mean_ratio(corners));
        m.patch_level.push_back(s.forest[patch].level);
        m.patch_error.push_back(s.patch_error[patch.value]);
    }
    for (const mesh::ZoneId zone : leaves.zones) {
        const auto corners = corners_of<4>(s.forest, zone);
        m.zone_volume.push_back(s.forest.volume(zone));
        m.zone_radius_ratio.push_back(radius_ratio(corners));
        m.zone_mean_ratio.push_back(mean_ratio(corners));
        m.zone_level.push_back(s.forest[zone].level);
        m.zone_error.push_back(s.zone_error[zone.value]);
        m.zone_thickness.push_back(thickness(s, zone, m.zone_volume.back()));
    }
    return m;
}

Spread spread_of(std::vector<double> values) {
    std::erase_if(values, [](double v) { return !std::isfinite(v); });
    Spread spread;
    spread.count = values.size();
    if (values.empty()) return spread;
    std::sort(values.begin(), values.end());
    spread.least = values.front();
    spread.most = values.back();
    spread.median = values[(values.size() - 1) / 2];
    spread.mean =
        std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    return spread;
}

}  // namespace tyndall::view
