// Values of bands, for the writers of path tracers' scenes.
#pragma once

#include <algorithm>
#include <array>

#include "radiosity/scene.h"

namespace tyndall::exports {

using radiosity::Spectrum;

inline bool any(const Spectrum& values) {
    return std::ranges::any_of(values, [](double v) { return v > 0.0; });
}

inline bool differ(const Spectrum& values) {
    return std::ranges::any_of(values, [&](double v) { return v != values[0]; });
}

inline Spectrum scaled(const Spectrum& values, double factor) {
    Spectrum result;
    for (const double v : values) result.push_back(factor * v);
    return result;
}

// Red, green and blue: one band three times.
inline std::array<double, 3> rgb(const Spectrum& values) {
    return values.size() == 3 ? std::array{values[0], values[1], values[2]}
                              : std::array{values[0], values[0], values[0]};
}

}  // namespace tyndall::exports
