// Light that a medium scatters once, looked at along a ray where its elements are too coarse for
// it.
#pragma once

#include <span>

#include "mesh/walk.h"
#include "radiosity/direct_light.h"
#include "radiosity/solution.h"

namespace tyndall::render {

// Purpose: what a leaf's H^A leaves out along one ray. Rays that graze the edge of a beam
//   cross a dozen leaves that straddle it, all wrong in the same way, and neighbours among them
//   each in its own: they would stand in the picture as lines.
// Equation: I = a ∫ κ T H^A dt over the chord of a leaf, with H^A evaluated on it, linear between
//   places that are added where it departs from that (59).
// Symbols: a albedo, T transmittance from where the chord begins.
// Valid for: leaves of media. Error: a tenth of the tolerance a piece, or what a 32nd of the chord
// leaves. Cost: 5 to 33 evaluations of direct light a chord that asks for it; none for others.
class SingleScattering {
  public:
    // `tolerance`: of the mean radiance of all elements; what a leaf's error may leave on a ray
    // (RenderOptions::scattering_tolerance) [-]. Keeps references to its arguments.
    SingleScattering(const radiosity::Solution& solution, const radiosity::DirectLight& light,
                     double tolerance);

    // ∫ κ T H^A dt between two distances in a leaf, one value a band; false, and nothing done,
    // where the leaf's error does not show: `transmittance` is that from the eye to t_in, of each
    // band [W/m^2/sr]. Thread-safe.
    bool along(const mesh::Ray& ray, mesh::ZoneId zone, double t_in, double t_out,
               std::span<const double> transmittance, std::span<double> gained) const;

  private:
    const radiosity::Solution& s_;
    const radiosity::DirectLight& light_;
    double threshold_;  // [W/m^2/sr]
};

}  // namespace tyndall::render
