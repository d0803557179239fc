// How much an error in one element matters: to the picture where there is a view, to the solution
// else.
#pragma once

#include <optional>

#include "radiosity/element_mesh.h"
#include "radiosity/view.h"

namespace tyndall::radiosity {

// weight × (error of x)² is the element's share of the squared relative error [1/(W/m^2/sr)²].
//
// Picture: an element of projected area P at distance d fills the solid angle P/d² of the view Ω,
// and an error δJ of a zone changes the radiance seen through it by κ (V/P) δJ, so its share is
//   patch: δI² (P/d²) / (Ω L²),   zone: (κ V/P)² δJ² (P/d²) / (Ω L²),      L the picture's mean
//   radiance. In an orthographic picture areas stand for the solid angles: P, and that of the
//   picture.
// Solution: c_i δx² / Σ c x². With a view this counts by a small share only, since what the camera
// does not see reaches the picture by reflection.
class Importance {
  public:
    struct Scale {
        double picture = 0.0;  // L: mean radiance of the picture [W/m^2/sr]
        double solution =
            0.0;  // Σ c x² over Σ c: mean square of what elements send out [(W/m^2/sr)^2]
    };
    Importance(const Enclosure& enclosure, const Forest& forest, const std::optional<View>& view,
               const Scale& scale);

    double of(ZoneId zone) const;
    double of(PatchId patch) const;

  private:
    const Enclosure& enclosure_;
    const Forest& forest_;
    std::optional<View> view_;
    double picture_factor_ = 0.0;   // 1 / (Ω L²)
    double solution_factor_ = 0.0;  // 1 / Σ c x²
};

// Mean of several bands' values, the measure by which errors of bands are joined.
double mean_over_bands(const Spectrum& values);

}  // namespace tyndall::radiosity
