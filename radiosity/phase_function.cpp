#include "radiosity/phase_function.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "radiosity/point_set.h"

namespace tyndall::radiosity {
namespace {

using std::numbers::pi;

double sample_cosine(const PhaseFunction& phase, double u) {
    if (phase.kind == PhaseKind::rayleigh) {
        // c³ + 3c = 8u − 4 has one real root, by Cardano's formula.
        const double half = 4.0 * u - 2.0;
        const double root = std::cbrt(std::abs(half) + std::sqrt(half * half + 1.0));
        return std::copysign(root - 1.0 / root, half);
    }
    const double g = phase.asymmetry;
    if (std::abs(g) < 1e-4) {  // to first order in g: the closed form divides by g
        const double c = 2.0 * u - 1.0;
        return c + 1.5 * g * (1.0 - c * c);
    }
    const double q = (1.0 - g * g) / (1.0 - g + 2.0 * g * u);
    return (1.0 + g * g - q * q) / (2.0 * g);
}

}  // namespace

double phase_value(const PhaseFunction& phase, double cosine) {
    if (phase.kind == PhaseKind::rayleigh)
        return 3.0 / (16.0 * pi) * (1.0 + cosine * cosine);  // (51)
    const double g = phase.asymmetry;
    if (g == 0.0) return 1.0 / (4.0 * pi);
    const double d = 1.0 + g * g - 2.0 * g * cosine;
    return (1.0 - g * g) / (4.0 * pi * d * std::sqrt(d));  // (51)
}

Direction sample_phase(const PhaseFunction& phase, Direction before, double u, double v) {
    const double cosine = std::clamp(sample_cosine(phase, u), -1.0, 1.0);
    return glm::normalize(direction_about(before, cosine, v));
}

}  // namespace tyndall::radiosity
