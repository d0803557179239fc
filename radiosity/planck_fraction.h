// Planck's law, integrated: what share of a black body's power lies below a wavelength.
#pragma once

namespace tyndall::radiosity {

inline constexpr double stefan_boltzmann = 5.670374419e-8;           // [W/m^2/K^4]
inline constexpr double second_radiation_constant = 1.438776877e-2;  // h c / k [m K]

// Purpose: the share of σT⁴ that a black body emits at wavelengths from 0 to λ, in vacuum:
//   F(λT) = 15/π⁴ ∫_ζ^∞ t³/(e^t − 1) dt,  ζ = C2/(λT)                                     (40)
//   by Σ_n e^{−nζ} (ζ³/n + 3ζ²/n² + 6ζ/n³ + 6/n⁴), or, below ζ = 1, by the power series of what is
//   missing to 1. Absolute error below 1e-11, relative below 1e-12 in the short waves.
// λT in [m K], from 0 (nothing) to infinity (all).
// Source: Chang & Rhee (1984); the series below 1: Debye's, with Bernoulli's numbers.
double planck_fraction(double wavelength_temperature);

}  // namespace tyndall::radiosity
