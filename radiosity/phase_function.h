// Phase functions: where scattered light goes.
#pragma once

#include "radiosity/scene.h"

namespace tyndall::radiosity {

// Φ of a medium, ∫ Φ dω = 1.
struct PhaseFunction {
    PhaseKind kind = PhaseKind::henyey_greenstein;
    double asymmetry = 0.0;  // g of Henyey–Greenstein [-]

    bool isotropic() const { return kind == PhaseKind::henyey_greenstein && asymmetry == 0.0; }
    bool operator==(const PhaseFunction&) const = default;
};

// Purpose: Φ for the cosine of the angle between the directions of travel before and after [1/sr].
// Equation: Henyey–Greenstein  (1 − g²) / (4π (1 + g² − 2 g cosθ)^{3/2})                     (51)
//           Rayleigh           3/(16π) (1 + cos²θ)
// Source: Henyey & Greenstein (1941); Rayleigh (1871), unpolarized.
double phase_value(const PhaseFunction& phase, double cosine);

// Purpose: a direction of travel distributed as Φ about the unit direction `before`, from two
//   numbers in [0, 1).
// Method: the cosine's distribution inverted in closed form (a cubic for Rayleigh, Frisvad 2011).
Direction sample_phase(const PhaseFunction& phase, Direction before, double u, double v);

}  // namespace tyndall::radiosity
