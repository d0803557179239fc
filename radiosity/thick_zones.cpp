#include "radiosity/thick_zones.h"

#include <algorithm>
#include <cmath>

namespace tyndall::radiosity {

bool is_thick(const Enclosure& enclosure, const Forest& forest, ZoneId zone, double thickness) {
    if (!forest.is_leaf(zone)) return false;
    double most = 0.0;
    for (std::size_t b = 0; b < enclosure.bands; ++b)
        most = std::max(most, extinction_in(enclosure, forest, zone, b).mean);
    return most * std::cbrt(forest.volume(zone)) > thickness;
}

bool any_thick(const Enclosure& enclosure, const ElementMesh& mesh, double thickness) {
    return std::any_of(mesh.zones().begin(), mesh.zones().end(), [&](ZoneId zone) {
        return is_thick(enclosure, mesh.forest(), zone, thickness);
    });
}

void bisect_thick_zones(const Enclosure& enclosure, ElementMesh& mesh, const Importance& importance,
                        Fields radiance, const ThicknessGoal& goal) {
    struct Candidate {
        double share;
        ZoneId zone;
    };
    const Forest& forest = mesh.forest();
    std::size_t leaves = 0;
    while (leaves != mesh.leaf_count() && mesh.leaf_count() < goal.max_elements) {
        leaves = mesh.leaf_count();
        extend(forest, radiance);
        std::vector<Candidate> candidates;
        double sum = 0.0;
        for (const ZoneId z : mesh.zones()) {
            if (!is_thick(enclosure, forest, z, goal.thickness)) continue;
            const double error = thickness_error({enclosure, mesh, forest, radiance, z});
            candidates.push_back({importance.of(z) * error * error, z});
            sum += candidates.back().share;
        }
        if (sum <= goal.squared_error) return;
        std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
            return a.share != b.share ? a.share > b.share : a.zone.value < b.zone.value;
        });
        for (const auto& [share, zone] : candidates) {
            if (share <= goal.squared_error / static_cast<double>(leaves)) break;
            if (mesh.leaf_count() >= goal.max_elements) break;
            mesh.bisect(zone, forest.longest_edge(zone));
        }
    }
}

}  // namespace tyndall::radiosity
