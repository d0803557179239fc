#include "radiosity/incident_lit.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "radiosity/open_places.h"

namespace tyndall::radiosity {
namespace {

// Points of degree 2 on an element, each with its part of the area or volume.
std::vector<std::pair<Receiver, double>> quadrature(const Enclosure& enclosure,
                                                    const Forest& forest, PatchId patch) {
    std::vector<std::pair<Receiver, double>> points;
    for (const VertexId corner : forest[patch].corners) {
        const Point x = 0.5 * (forest.point(corner) + forest.centroid(patch));
        points.push_back({{x, mesh::tet_before(enclosure.mesh, forest.base_facet_side(patch), x),
                           normal_of(forest, patch), true},
                          forest.area(patch) / 3.0});
    }
    return points;
}

std::vector<std::pair<Receiver, double>> quadrature(const Enclosure& enclosure,
                                                    const Forest& forest, ZoneId zone) {
    constexpr double towards_corner = 0.4472135954999579;  // 1/√5
    const MediumOptics& optics = enclosure.media[medium_of(enclosure, forest, zone)];
    std::vector<std::pair<Receiver, double>> points;
    for (const VertexId corner : forest[zone].corners) {
        const Point centre = forest.centroid(zone);
        const Point x = centre + towards_corner * (forest.point(corner) - centre);
        double size = forest.volume(zone) / 4.0;
        if (!optics.varying.empty()) {
            // A zone is met as often as it is dense.
            double density = least_density * optics.extinction[0] + 1e-300;
            for (const ExtinctionBand& band : optics.varying) density += band.at(x);
            size *= density;
        }
        const OpenPlace place = open_place(enclosure, x, forest.base_tet(zone));
        points.push_back({{place.x, place.tet}, size});
    }
    return points;
}

}  // namespace

std::vector<double> incident_lit(const Enclosure& enclosure, const Forest& forest,
                                 const Elements& e, const LitPatches& lit) {
    std::vector<double> incident(e.size() * e.bands, 0.0);
    tbb::parallel_for(std::size_t(0), e.size(), [&](std::size_t i) {
        const std::span<double> sum(incident.data() + i * e.bands, e.bands);
        std::vector<double> here(e.bands);
        double measure = 0.0;
        for (const std::uint32_t member : e.members_of(i)) {
            const auto points = e.is_patch(i) ? quadrature(enclosure, forest, PatchId(member))
                                              : quadrature(enclosure, forest, ZoneId(member));
            for (const auto& [receiver, size] : points) {
                std::fill(here.begin(), here.end(), 0.0);
                lit.gather(receiver, here);
                measure += size;
                for (std::size_t b = 0; b < e.bands; ++b) sum[b] += size * here[b];
            }
        }
        for (double& value : sum) value /= measure;
    });
    return incident;
}

}  // namespace tyndall::radiosity
