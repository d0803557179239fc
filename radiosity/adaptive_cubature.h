// Adaptive integration over the unit square, for integrands that are rough along lines.
#pragma once

#include <cstddef>
#include <functional>

namespace tyndall::radiosity {

struct Integral {
    double value = 0.0;
    double error = 0.0;   // estimated, absolute
    bool reached = true;  // whether the error is as small as was asked
};

struct CubatureOptions {
    double relative = 1e-6;  // of the value's size
    double absolute = 0.0;
    std::size_t evaluations = 2'000'000;  // at most
};

// ∫∫ f(u, v) du dv over [0, 1]², f evaluated in the open square only.
// Method: cells with the tensor rule of seven Gauss points; null rules of degrees 4 and 6 in either
//   direction tell how fast its series falls and so what is left. The cell that leaves most is
//   halved, across the direction that leaves more: cells grow thin along an edge where the
//   integrand is singular, and their number goes with the logarithm of the error.
// Cost: 49 evaluations a cell.
// Source: Berntsen & Espelid (1991), null rules; van Dooren & de Ridder (1976), global adaptivity.
Integral integrate_square(const std::function<double(double, double)>& f,
                          const CubatureOptions& options);

}  // namespace tyndall::radiosity
