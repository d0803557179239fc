#include "radiosity/uneven_zones.h"

#include <algorithm>
#include <cmath>

namespace tyndall::radiosity {
namespace {

// Mean of J over each region, one value a band [region * bands + band].
std::vector<double> region_means(const Enclosure& enclosure, const Forest& forest,
                                 const Fields& sources) {
    const std::size_t bands = sources.bands;
    std::vector<double> mean(enclosure.mesh.region_count * bands, 0.0);
    std::vector<double> volume(enclosure.mesh.region_count, 0.0);
    for (std::size_t t = 0; t < enclosure.mesh.tets.size(); ++t) {
        const ZoneId root = mesh::root_zone(TetId(t));
        const std::uint32_t region = enclosure.mesh.regions[t].value;
        volume[region] += forest.volume(root);
        for (std::size_t b = 0; b < bands; ++b)
            mean[region * bands + b] +=
                forest.volume(root) * sources.at(root, b).at(forest.centroid(root));
    }
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] /= std::max(volume[k / bands], 1e-300);
    return mean;
}

// The most by which two functions differ at a zone's corners, and so anywhere in it.
double departure(const Forest& forest, ZoneId zone, const Affine& f, const Affine& g) {
    double most = 0.0;
    for (const VertexId corner : forest[zone].corners) {
        const Point x = forest.point(corner);
        most = std::max(most, std::abs(f.at(x) - g.at(x)));
    }
    return most;
}

}  // namespace

std::vector<ZoneId> uneven_zones(const Enclosure& enclosure, const Forest& forest,
                                 const Fields& sources) {
    const std::size_t bands = sources.bands;
    const std::vector<double> means = region_means(enclosure, forest, sources);
    std::vector<double> departures(forest.zone_count() * bands, 0.0);
    std::vector<ZoneId> uneven;
    for (std::size_t z = forest.zone_count(); z-- > 0;) {  // children come after their parents
        const ZoneId zone(z);
        if (forest.is_leaf(zone)) continue;
        const TetId tet = forest.base_tet(zone);
        const std::size_t region = enclosure.mesh.regions[tet.value].value;
        bool is_uneven = false;
        for (std::size_t b = 0; b < bands; ++b) {
            double& most = departures[z * bands + b];
            for (const std::uint64_t k : {0, 1}) {
                const ZoneId child(forest[zone].first_child.value + k);
                most = std::max(
                    most, departures[child.value * bands + b] +
                              departure(forest, child, sources.at(zone, b), sources.at(child, b)));
            }
            is_uneven =
                is_uneven || enclosure.extinction(tet, b) * forest[zone].longest_edge * most >
                                 means[region * bands + b];
        }
        if (is_uneven) uneven.push_back(zone);
    }
    return uneven;
}

}  // namespace tyndall::radiosity
