// The parts that make up a picture, as renderers that follow paths sum them.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

namespace tyndall::render {

// By what the first thing seen does, surface or medium, and how light came to it.
enum Part : std::size_t {
    emission,             // light that was emitted, and nothing else
    surfaces_direct,      // reflected by a surface, straight from a light
    surfaces_indirect,    //   from anywhere else
    single_scattering,    // scattered by a medium, straight from a light
    multiple_scattering,  //   from anywhere else
    specular_reflection,  // reflected by a mirror or a glossy surface, whatever it shows
    part_count
};

inline constexpr std::array<const char*, part_count> part_names{
    "emission",          "surfaces_direct",     "surfaces_indirect",
    "single_scattering", "multiple_scattering", "specular_reflection"};

// What one ray sees: [part * bands + band], the transmittance to what it ends on, and how far that
// is.
struct Seen {
    std::vector<double> radiance;                            // [W/m^2/sr]
    std::vector<double> transmittance;                       // [-]
    double depth = std::numeric_limits<double>::infinity();  // [m]

    void clear(std::size_t bands) {
        radiance.assign(part_count * bands, 0.0);
        transmittance.assign(bands, 1.0);
        depth = std::numeric_limits<double>::infinity();
    }
};

}  // namespace tyndall::render
