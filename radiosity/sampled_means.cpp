#include "radiosity/sampled_means.h"

#include <tbb/parallel_for.h>

#include "radiosity/open_places.h"
#include "radiosity/point_set.h"

namespace tyndall::radiosity {
namespace {

// A net of 32 points finds the lit share of a leaf to a tenth or better; what is left has either
// sign from leaf to leaf.
const PointSet& net_points() {
    static const PointSet set(32);
    return set;
}

// Streams of their own for zones and patches, so that no leaf has the points of another.
constexpr std::uint64_t zone_seed = 0x7a6f6e65, patch_seed = 0x70617463;

}  // namespace

void SampledMeans::evaluate(ZoneId zone, double* mean) const {
    const auto& corners = forest_[zone].corners;
    const TetId tet = forest_.base_tet(zone);
    std::vector<double> incident(enclosure_.bands);
    for (std::size_t k = 0; k < net_points().size(); ++k) {
        const auto u = net_points()(k, hash_seed(zone_seed, zone.value));
        const auto w = uniform_in_tet(u[0], u[1], u[2]);
        Point x(0.0);
        for (int c = 0; c < 4; ++c) x += w[c] * forest_.point(corners[c]);
        const OpenPlace place = open_place(enclosure_, x, tet);
        light_.at_zone(place.x, place.tet, incident);
        for (std::size_t b = 0; b < incident.size(); ++b)
            mean[b] += incident[b] / static_cast<double>(net_points().size());
    }
}

void SampledMeans::evaluate(PatchId patch, double* mean) const {
    const auto& corners = forest_[patch].corners;
    const TetId tet =
        mesh::tet_before(enclosure_.mesh, forest_.base_facet_side(patch), forest_.centroid(patch));
    const Direction normal = normal_of(forest_, patch);
    std::vector<double> incident(enclosure_.bands);
    for (std::size_t k = 0; k < net_points().size(); ++k) {
        const auto u = net_points()(k, hash_seed(patch_seed, patch.value));
        const auto w = uniform_in_triangle(u[0], u[1]);
        Point x(0.0);
        for (int c = 0; c < 3; ++c) x += w[c] * forest_.point(corners[c]);
        light_.at_patch(x, normal, tet, incident);
        for (std::size_t b = 0; b < incident.size(); ++b)
            mean[b] += incident[b] / static_cast<double>(net_points().size());
    }
}

template <class Node>
void SampledMeans::add(const std::vector<Node>& nodes, Sampled& sampled) {
    std::vector<Node> fresh;
    for (const Node node : nodes) {
        if (node.value >= sampled.place.size()) sampled.place.resize(node.value + 1ull, none);
        if (sampled.place[node.value] != none) continue;
        sampled.place[node.value] = static_cast<std::uint32_t>(sampled.means.size());
        sampled.means.resize(sampled.means.size() + enclosure_.bands, 0.0);
        fresh.push_back(node);
    }
    tbb::parallel_for(std::size_t(0), fresh.size(), [&](std::size_t k) {
        evaluate(fresh[k], &sampled.means[sampled.place[fresh[k].value]]);
    });
}

template void SampledMeans::add(const std::vector<ZoneId>&, Sampled&);
template void SampledMeans::add(const std::vector<PatchId>&, Sampled&);

}  // namespace tyndall::radiosity
