// Temperatures found, where they have a meaning (Enclosure::thermal).
#pragma once

#include "radiosity/solution.h"

namespace tyndall::radiosity {

// Purpose: the temperature of what emits, given what it sends out and what falls on it, H one value
//   a band [W/m^2/sr]:
//   a side:    Σ ε_b f_b(T) σT⁴/π = Σ (x_b − ρ_b H_b),            x_b = e_b + a_b H_b
//   a medium:  Σ κ_a,b f_b(T) σT⁴/π = Σ κ_t,b (x_b − Ω_b H_b)                              (43)
//   `emission`: e_b. With a given flux or heat (a = 1) that is the temperature at which they are
//   kept up; else the one that was given, or that of a grey body which emits as much.
// NaN where nothing emits (ε = 0, κ_a = 0), or where less than nothing would have to be emitted: a
//   sink asks for more than arrives [K].
// Source: theory.md, "Heat".
double temperature_of(const SpectralModel& model, const SurfaceSide& side,
                      std::span<const double> emission, std::span<const double> incident);
double temperature_of(const SpectralModel& model, const MediumOptics& medium,
                      std::span<const double> emission, std::span<const double> incident);

// The same at a point of it. Where it settles by its heat in several bands, the temperature at
// which it emits what it takes up at the very point, R of (44); `emission`, its element's, is that
// of R's mean.
double temperature_there(const SpectralModel& model, const SurfaceSide& side,
                         std::span<const double> emission, std::span<const double> incident);
double temperature_there(const SpectralModel& model, const MediumOptics& medium,
                         std::span<const double> emission, std::span<const double> incident);

// temperature_of a leaf, at its centroid; NaN where there is no medium, or a side that faces none.
double temperature_of(const Solution& solution, PatchId patch);
double temperature_of(const Solution& solution, ZoneId zone);
// temperature_there, with the leaf's H at the point.
double temperature_at(const Solution& solution, PatchId patch, Point x);
double temperature_at(const Solution& solution, ZoneId zone, Point x);

// Purpose: into the report, of every side and medium that has one: the mean over its leaves, by
//   area or volume, the lowest and the highest; nothing where temperatures have no meaning. Leaves
//   without one are left out, and a warning says of what and how many. Cost: a pass over the
//   leaves.
void report_temperatures(Solution& solution);

}  // namespace tyndall::radiosity
