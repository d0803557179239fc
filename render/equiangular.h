// Places along a ray beside a light that has a place.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "render/path_media.h"

namespace tyndall::render {

// Purpose: distances along a ray, between `begin` and `end`, that see a point under evenly
//   distributed angles: the 1/r² of its light has no noise then.
// Equation: p(t) = D / ((θ_end − θ_begin) (D² + (t − t₀)²)), t₀ the foot of the point on the ray
// and
//   D its distance from it.                                                                 (53)
// Source: Kulla & Fajardo (2012).
class Equiangular {
  public:
    Equiangular(const PassedRay& ray, double begin, double end, Point at)
        : begin_(begin),
          end_(end),
          foot_(glm::dot(at - ray.origin, ray.direction)),
          distance_(glm::distance(at, ray.origin + foot_ * ray.direction)),
          first_(std::atan2(begin - foot_, distance_)),
          angle_(std::atan2(end - foot_, distance_) - first_) {}

    // Whether the point is beside the ray, not on it.
    bool good() const { return distance_ > 1e-9 * (end_ - begin_) && angle_ > 0.0; }

    // From a number in [0, 1) [m].
    double sample(double u) const {
        return std::clamp(foot_ + distance_ * std::tan(first_ + u * angle_), begin_, end_);
    }
    // [1/m].
    double density(double t) const {
        if (!good() || t < begin_ || t > end_) return 0.0;
        const double from_foot = t - foot_;
        return distance_ / (angle_ * (distance_ * distance_ + from_foot * from_foot));  // (53)
    }

  private:
    double begin_, end_, foot_, distance_, first_, angle_;
};

}  // namespace tyndall::render
