#include "radiosity/importance.h"

#include <cmath>
#include <numeric>

namespace tyndall::radiosity {
namespace {

// What an error that the camera does not see counts against one that it sees.
constexpr double unseen_share = 0.02;

}  // namespace

double mean_over_bands(const Spectrum& values) {
    if (values.empty()) return 0.0;
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

Importance::Importance(const Enclosure& enclosure, const Forest& forest,
                       const std::optional<View>& view, const Scale& scale)
    : enclosure_(enclosure), forest_(forest), view_(view) {
    double capacity = 0.0;
    for (std::size_t p = 0; p < 2 * enclosure.mesh.facets.size(); ++p)
        if (side_of(enclosure, forest, PatchId(p)) != none) capacity += forest.area(PatchId(p));
    for (std::size_t t = 0; t < enclosure.mesh.tets.size(); ++t)
        if (const auto m = medium_of(enclosure, forest, ZoneId(t)); m != none)
            capacity +=
                4.0 * rough_extinction(enclosure, forest, ZoneId(t)) * forest.volume(ZoneId(t));
    if (scale.solution > 0.0 && capacity > 0.0)
        solution_factor_ = 1.0 / (capacity * scale.solution);
    if (view_ && scale.picture > 0.0) {
        picture_factor_ = 1.0 / (view_->extent() * scale.picture * scale.picture);
        solution_factor_ *= unseen_share;
    }
}

double Importance::of(ZoneId zone) const {
    const auto medium = medium_of(enclosure_, forest_, zone);
    if (medium == none) return 0.0;
    const double extinction = rough_extinction(enclosure_, forest_, zone);
    const double volume = forest_.volume(zone);
    double weight = solution_factor_ * 4.0 * extinction * volume;
    if (picture_factor_ > 0.0) {
        const double size = forest_[zone].longest_edge;
        const Point centre = forest_.centroid(zone);
        if (view_->sees(centre, size)) {
            const double projected = std::cbrt(volume) * std::cbrt(volume);
            const double chord = extinction * volume / projected;
            weight += picture_factor_ * chord * chord * view_->covered(centre, projected, size);
        }
    }
    return weight;
}

double Importance::of(PatchId patch) const {
    if (side_of(enclosure_, forest_, patch) == none) return 0.0;
    const double area = forest_.area(patch);
    double weight = solution_factor_ * area;
    if (picture_factor_ > 0.0) {
        const double size = forest_[patch].longest_edge;
        const Point centre = forest_.centroid(patch);
        const double distance = view_->distance_to(centre);
        const double cosine = -glm::dot(normal_of(forest_, patch), view_->direction_to(centre));
        // A patch seen edge-on at its centre may still turn a corner to the camera.
        const double facing = std::max(cosine, cosine * distance > -size ? 0.02 : 0.0);
        if (facing > 0.0 && view_->sees(centre, size))
            weight += picture_factor_ * view_->covered(centre, area * facing, size);
    }
    return weight;
}

}  // namespace tyndall::radiosity
