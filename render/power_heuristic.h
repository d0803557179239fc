// Weights of samples that several ways of sampling may find.
#pragma once

namespace tyndall::render {

// Purpose: the weight of a sample that was found by the way with density a, among ways that find it
//   with densities a, b, c: their weights add up to 1.
// Equation: a² / (a² + b² + c²)                                                             (54)
// Source: Veach & Guibas (1995).
inline double power_heuristic(double a, double b, double c = 0.0) {
    if (!(a > 0.0)) return 0.0;
    const double p = b / a, q = c / a;
    return 1.0 / (1.0 + p * p + q * q);
}

}  // namespace tyndall::render
