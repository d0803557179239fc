#include "radiosity/black_body.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tyndall::radiosity {
namespace {

using std::numbers::pi;

double grey_temperature(double radiance) {
    return std::pow(pi * radiance / stefan_boltzmann, 0.25);
}

double emitted(const SpectralModel& model, std::span<const double> weights, double temperature) {
    double sum = 0.0;
    for (std::size_t b = 0; b < weights.size(); ++b)
        if (weights[b] > 0.0) sum += weights[b] * black_share(model, b, temperature);
    return sum * stefan_boltzmann * std::pow(temperature, 4) / pi;
}

}  // namespace

double black_share(const SpectralModel& model, std::size_t band, double temperature) {
    if (!model.grey_gases.gases.empty())
        return grey_gas_weight(model.grey_gases, band, temperature);
    if (model.band_edges.empty()) return 1.0;
    return planck_fraction(model.band_edges[band + 1] * temperature) -
           planck_fraction(model.band_edges[band] * temperature);
}

std::vector<double> black_radiance(const SpectralModel& model, std::size_t bands,
                                   double temperature) {
    std::vector<double> result(bands);
    const double all = stefan_boltzmann * std::pow(temperature, 4) / pi;
    for (std::size_t b = 0; b < bands; ++b) result[b] = all * black_share(model, b, temperature);
    return result;
}

double temperature_of(const SpectralModel& model, std::span<const double> weights, double total) {
    const double most = *std::max_element(weights.begin(), weights.end());
    if (!(most > 0.0) || !(total >= 0.0)) return std::numeric_limits<double>::quiet_NaN();
    if (total == 0.0) return 0.0;
    if (model.empty()) return grey_temperature(total / most);
    // With all of σT⁴ in the band of the largest weight it would be as cold as it can be.
    double low = grey_temperature(total / most), high = 2.0 * low;
    while (emitted(model, weights, high) < total && high < 1e9) high *= 2.0;
    // Secants of ln P over ln T, whose slope is 4 or a little more, kept between the bounds.
    double t = low, power = emitted(model, weights, t), slope = 4.0;
    for (int step = 0; step < 100; ++step) {
        (power < total ? low : high) = t;
        double next = power > 0.0 ? t * std::pow(total / power, 1.0 / slope) : 0.0;
        if (!(next > low && next < high)) next = std::sqrt(low * high);
        if (std::abs(next - t) <= 1e-13 * t || high - low <= 1e-13 * high) return next;
        const double before = power, at = t;
        t = next;
        power = emitted(model, weights, t);
        if (before > 0.0 && power > 0.0 && power != before)
            slope = std::log(power / before) / std::log(t / at);
        if (!(slope > 1.0 && slope < 1e3)) slope = 4.0;
    }
    return t;
}

}  // namespace tyndall::radiosity
