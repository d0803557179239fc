#include "radiosity/grey_gases.h"

#include <algorithm>

namespace tyndall::radiosity {
namespace {

double weight_of(const GreyGas& gas, double temperature) {
    double sum = 0.0;
    for (std::size_t j = gas.weights.size(); j-- > 0;) sum = sum * temperature + gas.weights[j];
    return sum;
}

}  // namespace

double grey_gas_weight(const GreyGases& model, std::size_t band, double temperature) {
    const double t = std::clamp(temperature, model.lowest, model.highest);
    if (band > 0) return weight_of(model.gases[band - 1], t);
    double rest = 1.0;
    for (const GreyGas& gas : model.gases) rest -= weight_of(gas, t);
    return rest;
}

}  // namespace tyndall::radiosity
