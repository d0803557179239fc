// Where the light goes: net power by name, the balance of energy, the check of direct light.
#pragma once

#include "radiosity/coarse_solution.h"
#include "radiosity/direct_light.h"

namespace tyndall::radiosity {

struct Balance {
    std::map<std::string, Spectrum> net_power;  // out of surface sides and media, into outside [W]
    double energy_balance = 0.0;  // (sent out − taken up − escaped) over what is brought in [-]
    // (received + escaped − emitted) / emitted, direct light only [-]
    double direct_power_check = 0.0;
};

// Net power of element i: π c_i (x_i − H_i) [W]; of outside: π Σ_i S_i,out r_i, plus direct light
// that escapes, minus what the environment sends in. Balance: Σ net + lights' power = 0. Direct
// light that escapes is found apart from H^A, by following `rays` Sobol' rays from every emitter,
// so that the check can fail.
// Cost: rays × lights walks.
Balance balance(const Enclosure& enclosure, const CoarseSolution& coarse,
                const std::vector<double>& incident_direct, const DirectLight& light,
                std::size_t rays, std::uint64_t seed);

}  // namespace tyndall::radiosity
