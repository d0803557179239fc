#include "view/plot_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace tyndall::view {
namespace {

// The nearest of 1, 2, 5 times a power of ten that is not above the value.
double round_down(double value) {
    const double decade = std::pow(10.0, std::floor(std::log10(value) + 1e-9));
    for (const double m : {5.0, 2.0})
        if (m * decade <= value * (1 + 1e-9)) return m * decade;
    return decade;
}

double round_up(double value) {
    const double below = round_down(value);
    if (below >= value * (1 - 1e-9)) return below;
    const double lead = below / std::pow(10.0, std::floor(std::log10(below) + 1e-9));
    return lead < 1.5 || lead > 4.5 ? 2.0 * below : 2.5 * below;
}

}  // namespace

double PlotAxis::at(double value) const {
    const double part =
        linear ? (value - low) / (high - low) : std::log(value / low) / std::log(high / low);
    return begin + (end - begin) * part;
}

bool PlotAxis::holds(double value) const {
    const double slack = 1e-9 * (linear ? high - low : value);
    return value >= low - slack && value <= high + slack;
}

PlotAxis log_axis(std::vector<double> values, double begin, double end) {
    if (values.empty()) values = {1.0, 100.0};
    constexpr double room = 1.05;
    const double low = *std::min_element(values.begin(), values.end()) / room;
    const double high = *std::max_element(values.begin(), values.end()) * room;
    return {round_down(low), round_up(high), begin, end};
}

PlotAxis linear_axis(const std::vector<double>& values, double begin, double end) {
    double high = 0.0;
    for (const double value : values) high = std::max(high, value);
    return {0.0, high > 0.0 ? 1.05 * high : 1.0, begin, end, true};
}

std::vector<double> log_ticks(double low, double high) {
    std::vector<double> decades, finer;
    const int first = static_cast<int>(std::floor(std::log10(low) - 1e-9));
    for (int k = first; std::pow(10.0, k) <= high * (1 + 1e-9); ++k)
        for (const double m : {1.0, 2.0, 5.0}) {
            const double v = m * std::pow(10.0, k);
            if (v < low * (1 - 1e-9) || v > high * (1 + 1e-9)) continue;
            finer.push_back(v);
            if (m == 1.0) decades.push_back(v);
        }
    return decades.size() < 3 ? finer : decades;
}

std::vector<double> linear_ticks(double high) {
    const double step = round_up(high / 10.0);
    std::vector<double> ticks;
    for (int k = 0; k * step <= high * (1 + 1e-9); ++k) ticks.push_back(k * step);
    return ticks;
}

std::vector<double> ticks_of(const PlotAxis& axis) {
    return axis.linear ? linear_ticks(axis.high) : log_ticks(axis.low, axis.high);
}

std::string tick_text(double value) {
    const int decade = static_cast<int>(std::floor(std::log10(value) + 1e-9));
    if (decade >= -3 && decade < 4) return fmt::format("{:g}", value);
    constexpr std::array<const char*, 10> raised{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string exponent = decade < 0 ? "⁻" : "";
    for (const char digit : std::to_string(std::abs(decade)))
        exponent += raised[static_cast<std::size_t>(digit - '0')];
    const double mantissa = value / std::pow(10.0, decade);
    const bool whole = std::abs(mantissa - 1.0) < 1e-6;
    return (whole ? "" : fmt::format("{:g}·", std::round(mantissa))) + "10" + exponent;
}

}  // namespace tyndall::view
