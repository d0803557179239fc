// A gas with lines as a few grey gases: the weighted sum of grey gases.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tyndall::radiosity {

struct GreyGas {
    double absorption = 0.0;        // of a partial pressure, beside its length [1/(m Pa)]
    std::vector<double> weights{};  // b_j: the weight is Σ_j b_j T^j [K^-j]
};

// Band 0 is the clear gas, the windows of the spectrum: it absorbs nothing and has the weight that
// the others leave. Band k ≥ 1 is gases[k − 1].
struct GreyGases {
    std::string name{};                  // for messages: the file
    double lowest = 0.0, highest = 0.0;  // temperatures the weights are valid for [K]
    std::vector<GreyGas> gases{};        // empty: there is no such model

    std::size_t bands() const { return gases.size() + 1; }
};

// Purpose: the share of a black body's σT⁴ that counts for a band, so that a gas of partial
// pressure p [Pa] has the emissivity over a length s
//   ε(T, p s) = Σ_k a_k(T) (1 − e^{−κ_k p s}),  a_k = Σ_j b_kj T^j,  a_0 = 1 − Σ_k a_k      (41)
// The shares of all bands add up to 1. Beyond `lowest` and `highest` they are those of the nearer.
// Source: Hottel & Sarofim (1967); coefficients as Smith, Shen & Friedman (1982) give them.
double grey_gas_weight(const GreyGases& model, std::size_t band, double temperature);

}  // namespace tyndall::radiosity
