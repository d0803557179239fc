#include "radiosity/planck_fraction.h"

#include <cmath>
#include <initializer_list>
#include <numbers>

namespace tyndall::radiosity {
namespace {

const double whole = std::pow(std::numbers::pi, 4) / 15.0;  // of the integral from 0

// ∫_0^ζ t³/(e^t − 1) dt for ζ ≤ 1: Σ_k B_k ζ^{k+3} / (k! (k + 3)). The next term is below 1e-14.
double long_waves(double zeta) {
    const double square = zeta * zeta;
    double sum = 0.0;
    for (const double term :
         {7.0 / 6.0 / (87178291200.0 * 17.0), -691.0 / 2730.0 / (479001600.0 * 15.0),
          5.0 / 66.0 / (3628800.0 * 13.0), -1.0 / 30.0 / (40320.0 * 11.0),
          1.0 / 42.0 / (720.0 * 9.0), -1.0 / 30.0 / (24.0 * 7.0), 1.0 / 6.0 / (2.0 * 5.0)})
        sum = sum * square + term;
    return zeta * square * (1.0 / 3.0 + zeta * (-1.0 / 8.0 + zeta * sum));
}

// The same from ζ to infinity, for ζ > 1.
double short_waves(double zeta) {
    double sum = 0.0;
    for (int n = 1; n <= 40; ++n) {
        const double m = 1.0 / n, factor = std::exp(-n * zeta);
        const double term =
            factor * m *
            (zeta * zeta * zeta + m * (3.0 * zeta * zeta + m * (6.0 * zeta + 6.0 * m)));
        sum += term;
        if (term <= 1e-16 * sum) break;
    }
    return sum;
}

}  // namespace

double planck_fraction(double wavelength_temperature) {
    if (!(wavelength_temperature > 0.0)) return 0.0;
    const double zeta = second_radiation_constant / wavelength_temperature;
    return zeta > 1.0 ? short_waves(zeta) / whole : 1.0 - long_waves(zeta) / whole;
}

}  // namespace tyndall::radiosity
