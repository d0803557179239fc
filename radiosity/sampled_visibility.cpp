#include "radiosity/sampled_visibility.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <vector>

#include "radiosity/point_set.h"

namespace tyndall::radiosity {
namespace {

constexpr double far = 1e6;  // of the hull's diagonal: as good as infinite for a shadow ray

// splitmix64's finaliser.
std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
}

glm::dvec2 shift_at(Point x) {
    std::uint64_t h = 0x9e3779b97f4a7c15ull;
    for (int axis = 0; axis < 3; ++axis) h = mix(h ^ std::bit_cast<std::uint64_t>(x[axis]));
    return {unit_number(h), unit_number(mix(h + 1))};
}

// Uniform points of a convex polygon from the unit square: the fan's triangles share the first
// coordinate.
class PolygonSampler {
  public:
    PolygonSampler(std::span<const Point> corners, std::vector<double>& cumulated)
        : corners_(corners), cumulated_(cumulated) {
        cumulated_.assign(1, 0.0);
        for (std::size_t k = 1; k + 1 < corners.size(); ++k)
            cumulated_.push_back(
                cumulated_.back() +
                glm::length(glm::cross(corners[k] - corners[0], corners[k + 1] - corners[0])));
    }
    Point operator()(glm::dvec2 u) const {
        const double at = u.x * cumulated_.back();
        const auto next = std::upper_bound(cumulated_.begin() + 1, cumulated_.end() - 1, at);
        const std::size_t k = static_cast<std::size_t>(next - cumulated_.begin());
        const double width = cumulated_[k] - cumulated_[k - 1];
        const double s = std::sqrt(width > 0.0 ? (at - cumulated_[k - 1]) / width : 0.0);
        return corners_[0] +
               s * (corners_[k] - corners_[0] + u.y * (corners_[k + 1] - corners_[k]));
    }

  private:
    std::span<const Point> corners_;
    std::vector<double>& cumulated_;
};

}  // namespace

void sampled_transmittance(const Occlusion& occlusion, const OpticalDepth& depth,
                           const Receiver& receiver, std::span<const Point> corners,
                           const Hull* hull, std::size_t rays, std::span<double> mean) {
    thread_local std::vector<double> cumulated, depths;
    depths.assign(mean.size(), 0.0);
    std::fill(mean.begin(), mean.end(), 0.0);
    const PolygonSampler sample(corners, cumulated);
    const glm::dvec2 shift = shift_at(receiver.x);
    double total = 0.0;
    for (std::size_t k = 0; k < rays; ++k) {
        const double n = static_cast<double>(k + 1);
        const Point p =
            sample(glm::fract(shift + n * glm::dvec2(0.7548776662466927, 0.5698402909980532)));
        const double s = glm::length(p);
        const Direction direction = p / s;
        const double weight = receiver.cosine(direction) / (s * s * s);
        total += weight;
        const double reach = hull ? far * glm::distance(hull->low, hull->high) : s;
        if (occlusion.blocked(receiver.x, direction * reach)) continue;
        if (!depth.transparent())
            depth(receiver.x, receiver.tet,
                  hull ? direction * hull->exit(receiver.x, direction) : p, depths);
        for (std::size_t band = 0; band < mean.size(); ++band)
            mean[band] += weight * std::exp(-depths[band]);
    }
    for (double& m : mean) m = total > 0.0 ? m / total : 0.0;
}

}  // namespace tyndall::radiosity
