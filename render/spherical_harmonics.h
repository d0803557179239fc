// Real spherical harmonics.
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

#include "mesh/types.h"

namespace tyndall::render {

constexpr std::size_t harmonics_count(std::size_t order) {
    return (order + 1) * (order + 1);
}

// Purpose: Y_lm of a unit direction for all l up to `order`, at [l (l + 1) + m], orthonormal over
//   the sphere; so that (addition theorem)  Σ_m Y_lm(u) Y_lm(v) = (2l + 1)/(4π) P_l(u · v).
// `values`: harmonics_count(order) of them [sr^-1/2].
// Method: recurrence of the normalized associated Legendre functions, with sin^m θ e^{imφ} taken
//   from x + iy. Cost: order².
inline void spherical_harmonics(mesh::Direction u, std::size_t order, std::span<double> values) {
    const auto at = [&](std::size_t l) { return &values[l * (l + 1)]; };
    double sectoral = 0.5 * std::sqrt(std::numbers::inv_pi);  // of l = m, without sin^m θ
    double real = 1.0, imaginary = 0.0;                       // (x + iy)^m
    for (std::size_t m = 0; m <= order; ++m) {
        if (m > 0) {
            sectoral *= std::sqrt((2.0 * double(m) + 1.0) / (2.0 * double(m)));
            const double before = real;
            real = real * u.x - imaginary * u.y;
            imaginary = before * u.y + imaginary * u.x;
        }
        double before = 0.0, here = sectoral;
        for (std::size_t l = m; l <= order; ++l) {
            const double factor = m == 0 ? 1.0 : std::numbers::sqrt2;
            at(l)[m] = factor * here * real;
            if (m > 0) at(l)[-std::ptrdiff_t(m)] = factor * here * imaginary;
            const double n = double(l) + 1.0, k = double(m);
            const double a = std::sqrt((4.0 * n * n - 1.0) / (n * n - k * k));
            const double b =
                std::sqrt((double(l) * double(l) - k * k) / (4.0 * double(l) * double(l) - 1.0));
            const double next = a * (u.z * here - (l > m ? b * before : 0.0));
            before = here;
            here = next;
        }
    }
}

}  // namespace tyndall::render
