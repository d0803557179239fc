// Indirect light right at a point of a surface, whatever the elements there are.
#pragma once

#include "radiosity/gather.h"
#include "radiosity/solution.h"

namespace tyndall::radiosity {

class FinalGather {
  public:
    // Keeps a reference to the solution. Cost: O(nodes).
    explicit FinalGather(const Solution& solution);

    // Purpose: H^I at a point of a surface that lies on the given side of its facet, one value a
    //   band [W/m^2/sr]: what all elements send out but for light that counts as direct, and what
    //   stands in the way right there.
    // Equation: (4) along cosine-weighted directions, `points` of them, for what is smooth; patches
    //   that direct light shines on, and bright places, are looked at on purpose (lit_patches.h,
    //   bright_places.h).
    // Error: that of the rays, falls as their number^-0.75; of the solution's elements as sources.
    // Cost: points walks, O(log patches) shadow rays. Thread-safe; depends on its arguments alone.
    // Source: final gathering: Rushmeier (1988), Lischinski, Tampieri & Greenberg (1993).
    void on_surface(PatchId leaf, Point x, const PointSet& points, std::uint64_t seed,
                    std::span<double> incident) const;

  private:
    FinalGather(const Solution& solution, const Fields& lit);

    const Solution& s_;
    LitPatches lit_;
    GatherScene rest_;
    std::optional<BrightPlaces> bright_;
};

}  // namespace tyndall::radiosity
