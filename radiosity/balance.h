// Where the light goes: net power by name, the balance of energy, the check of direct light.
#pragma once

#include "radiosity/coarse_solution.h"
#include "radiosity/direct_light.h"

namespace tyndall::radiosity {

struct Balance {
    std::map<std::string, Spectrum> net_power;  // out of surface sides and media, into outside [W]
    std::map<std::string, Spectrum> net_flux;   // the same over a side's area [W/m^2]
    std::map<std::string, Spectrum> flux_divergence;  // over a medium's volume [W/m^3]
    double energy_balance = 0.0;  // (sent out − taken up − escaped) over what is brought in [-]
};

// Power of light from emitters and lights that leaves the hull unscattered, a value a band [W].
struct Escaped {
    Spectrum direct;        // straight; of lights by way of mirrors, too, as H^A has it
    Spectrum in_mirrors;    // of emitting surfaces, by way of mirrors
    Spectrum onto_mirrors;  // of emitting surfaces: what mirrors reflect of what comes straight
};

// Purpose: that power found apart from H^A, by following `rays` Sobol' rays from every emitter and
// light, so that a check against it can fail.
// Cost: rays × lights walks; none where the hull is closed and nothing is a mirror.
Escaped escaped_direct(const Enclosure& enclosure, const CoarseSolution& coarse, std::size_t rays,
                       std::uint64_t seed);

// Purpose: H^A of the coarse elements (`incident_direct`, [element * bands + band]) made to take up
//   as much as is emitted, in a closed hull: f Σ π c_i H^A_i = P_emitted, one f for all. Through an
//   optically thick medium hardly anything of the emitted power passes, and an error of it, in the
//   quadrature over elements of many mean free paths, would be many times that of what passes.
//   Where the hull is open nothing is changed: what escapes is sampled, and not known as well. What
//   mirrors take of emitters goes through the rows (coarse_solution.h), and is left out of
//   P_emitted; it is sampled, too, and nothing is changed where it is more than half.
// Returns the check before: (received + onto mirrors + escaped − emitted) / emitted [-].
double conserve_direct_power(const Enclosure& enclosure, const Elements& elements,
                             const DirectLight& light, const Escaped& escaped,
                             std::vector<double>& incident_direct);

// Net power of element i: π c_i (x_i − H_i) [W]; of outside: π Σ_i S_i,out r_i, plus direct light
// that escapes, minus what the environment sends in. Balance: Σ net + lights' power = 0.
Balance balance(const Enclosure& enclosure, const CoarseSolution& coarse,
                const std::vector<double>& incident_direct, const DirectLight& light,
                const Escaped& escaped);

}  // namespace tyndall::radiosity
