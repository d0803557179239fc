// An enclosure all at one temperature, in which everything has radiance 1.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "radiosity/enclosure.h"

namespace tyndall::test {

// Sides and media emit what they do not reflect or scatter, outside has radiance 1, lights are out.
inline void make_furnace(radiosity::Enclosure& e) {
    for (auto& side : e.sides) {
        side.settled_flux.reset();
        for (std::size_t b = 0; b < e.bands; ++b) side.emission[b] = 1.0 - side.reflectance[b];
    }
    for (auto& medium : e.media) {
        medium.settled_heat.reset();
        for (std::size_t b = 0; b < e.bands; ++b) medium.emission[b] = 1.0 - medium.albedo[b];
    }
    e.environment.assign(e.bands, 1.0);
    e.lights.clear();
}

// Of radiances from the furnace's.
inline double largest_departure(const std::vector<double>& values) {
    double most = 0.0;
    for (const double value : values) most = std::max(most, std::abs(value - 1.0));
    return most;
}

}  // namespace tyndall::test
