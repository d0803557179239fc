// What a black body sends out in the bands of a scene, and the temperature that belongs to a power.
#pragma once

#include <span>
#include <vector>

#include "radiosity/grey_gases.h"
#include "radiosity/planck_fraction.h"

namespace tyndall::radiosity {

// What the bands of a scene are, where they have to do with temperature. Nothing given and one
// band: that band is the whole spectrum. Nothing given and several bands: temperatures have no
// meaning.
struct SpectralModel {
    // bands + 1 wavelengths, ascending, from 0 to infinity at the most [m].
    std::vector<double> band_edges{};
    GreyGases grey_gases{};  // or these

    bool empty() const { return band_edges.empty() && grey_gases.gases.empty(); }
    // Whether temperatures have a meaning in a scene of so many bands.
    bool thermal(std::size_t bands) const { return bands == 1 || !empty(); }
};

// f_b(T), the share of σT⁴ in a band: (40) between its edges, or (41) [-].
double black_share(const SpectralModel& model, std::size_t band, double temperature);

// f_b(T) σT⁴/π, one value a band [W/m^2/sr].
std::vector<double> black_radiance(const SpectralModel& model, std::size_t bands,
                                   double temperature);

// Purpose: the temperature at which a body emits what it does: T with
//   Σ_b w_b f_b(T) σT⁴/π = Σ_b w_b J_b =: total                                            (42)
// with w its emissivity (absorption coefficient), one value a band. In closed form where f is 1,
// else by Newton's method within bounds. NaN where all w are 0 or the total is negative [K].
double temperature_of(const SpectralModel& model, std::span<const double> weights, double total);

}  // namespace tyndall::radiosity
