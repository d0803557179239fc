#include "render/colour_map.h"

#include <algorithm>
#include <cmath>

namespace tyndall::render {
namespace {

double percentile(std::vector<double>& values, double share) {
    const auto at = values.begin() +
                    static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

}  // namespace

Colour map_colour(double t) {
    constexpr double c[7][3] = {
        {0.2777273, 0.0054073, 0.3340998},   {0.1050930, 1.4046135, 1.3845902},
        {-0.3308618, 0.2148476, 0.0950952},  {-4.6342305, -5.7991010, -19.3324410},
        {6.2282699, 14.1799334, 56.6905526}, {4.7763850, -13.7451454, -65.3530326},
        {-5.4354559, 4.6458526, 26.3124352}};
    t = std::isfinite(t) ? std::clamp(t, 0.0, 1.0) : 0.0;
    Colour colour;
    for (std::size_t k = 0; k < 3; ++k) {
        double value = 0.0;
        for (int power = 6; power >= 0; --power) value = value * t + c[power][k];
        colour[k] = 255.0 * std::clamp(value, 0.0, 1.0);
    }
    return colour;
}

Colour ColourScale::operator()(double value) const {
    if (!(value > low)) return map_colour(0.0);
    return map_colour(logarithmic ? std::log(value / low) / std::log(high / low)
                                  : (value - low) / (high - low));
}

ColourScale scale_for(std::vector<double> values, bool logarithmic) {
    std::erase_if(values, [&](double v) { return !std::isfinite(v) || (logarithmic && v <= 0.0); });
    if (values.empty()) return {logarithmic ? 0.1 : 0.0, 1.0, logarithmic};
    const double high = percentile(values, 0.995), low = percentile(values, 0.005);
    if (logarithmic) return {std::clamp(low, 1e-3 * high, 0.5 * high), high, true};
    return {low, high > low ? high : low + 1.0, false};
}

}  // namespace tyndall::render
