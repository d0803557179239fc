#include "render/tone_map.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/input_error.h"

namespace tyndall::render {

namespace {

constexpr double middle_grey = 0.18;
constexpr double linear_end = 0.6;   // a of the shoulder
constexpr double white_input = 2.2;  // x that gives 1: a + 4 (1 − a), so that the slope continues
constexpr double film_white = 11.2;  // of Hable's curve
constexpr double lit_fraction = 1e-3;  // of the mean: darker pixels say nothing about the exposure

// What the eye makes of a pixel. Rec. 709 weights for three channels.
double luminance(const float* pixel, std::size_t channels) {
    if (channels == 3) return 0.2126 * pixel[0] + 0.7152 * pixel[1] + 0.0722 * pixel[2];
    double sum = 0.0;
    for (std::size_t band = 0; band < channels; ++band) sum += pixel[band];
    return sum / static_cast<double>(channels);
}

// Threshold of a pixel, in [0, 1): the R2 lattice. Channels are a third apart, which keeps the
// noise of their sum small.
double threshold(std::size_t x, std::size_t y, std::size_t channel) {
    constexpr double g = 1.32471795724474602596;  // the plastic number
    const double value = (static_cast<double>(x) + 0.5) / g +
                         (static_cast<double>(y) + 0.5) / (g * g) +
                         static_cast<double>(channel) / 3.0;
    return value - std::floor(value);
}

std::uint8_t code(double light, double dither) {
    const double exact = 255.0 * srgb_encode(light);
    return static_cast<std::uint8_t>(std::min(255.0, std::floor(exact + dither)));
}

double white_of(const Image& image, const Layer& layer, const ToneMapOptions& options) {
    if (options.white && !(*options.white > 0.0 && std::isfinite(*options.white)))
        throw mesh::InputError(fmt::format(
            "the radiance shown as white is {}. Give a positive number.", *options.white));
    if (!std::isfinite(options.exposure))
        throw mesh::InputError(
            fmt::format("the exposure is {}. Give a number of stops.", options.exposure));
    const double white = options.white ? *options.white : automatic_white(image, layer);
    return white / std::exp2(options.exposure);
}

}  // namespace

double automatic_white(const Image&, const Layer& layer) {
    std::vector<double> lit;
    double sum = 0.0;
    for (std::size_t at = 0; at + layer.channels <= layer.values.size(); at += layer.channels) {
        const double value = luminance(&layer.values[at], layer.channels);
        if (!(value > 0.0) || !std::isfinite(value)) continue;
        lit.push_back(value);
        sum += value;
    }
    if (lit.empty()) return 1.0;
    const double least = lit_fraction * sum / static_cast<double>(lit.size());
    double logs = 0.0;
    std::size_t count = 0;
    for (const double value : lit) {
        if (value < least) continue;
        logs += std::log(value);
        ++count;
    }
    return std::exp(logs / static_cast<double>(count)) * white_input / middle_grey;
}

double shoulder(double s) {
    const double x = white_input * s;
    if (!(x > 0.0)) return 0.0;
    if (x <= linear_end) return x;
    if (x >= white_input) return 1.0;
    const double left = 1.0 - (x - linear_end) / (white_input - linear_end);
    return 1.0 - (1.0 - linear_end) * left * left * left * left;
}

double tone_curve(ToneCurve curve, double s) {
    if (!(s > 0.0)) return 0.0;
    if (s >= 1.0) return 1.0;
    const double x = white_input * s;
    const auto film = [](double v) {
        return (v * (0.15 * v + 0.05) + 0.004) / (v * (0.15 * v + 0.5) + 0.06) - 1.0 / 15.0;
    };
    switch (curve) {
        case ToneCurve::shoulder:
            break;
        case ToneCurve::filmic:
            return film(film_white * s) / film(film_white);
        case ToneCurve::reinhard:
            return x * (1.0 + x / (white_input * white_input)) / (1.0 + x);
        case ToneCurve::linear:
            return std::min(x, 1.0);
    }
    return shoulder(s);
}

std::span<const std::string_view> tone_curve_names() {
    static constexpr std::array<std::string_view, 4> names{"shoulder", "filmic", "reinhard",
                                                           "linear"};
    return names;
}

ToneCurve tone_curve_named(std::string_view name) {
    const auto names = tone_curve_names();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
        throw mesh::InputError(fmt::format("there is no tone curve \"{}\". Choose one of {}.", name,
                                           fmt::join(names, ", ")));
    return static_cast<ToneCurve>(found - names.begin());
}

double srgb_encode(double light) {
    return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1.0 / 2.4) - 0.055;
}

DisplayImage tone_map(const Image& image, const ToneMapOptions& options, const std::string& name) {
    check_sizes(image);
    const Layer layer = select_layer(image, name);
    const double white = white_of(image, layer, options);
    DisplayImage display{image.width, image.height, layer.channels == 3 ? 3u : 1u, {}};
    display.values.resize(image.width * image.height * display.channels);
    for (std::size_t y = 0; y < image.height; ++y)
        for (std::size_t x = 0; x < image.width; ++x) {
            const std::size_t pixel = y * image.width + x;
            const float* values = &layer.values[pixel * layer.channels];
            for (std::size_t channel = 0; channel < display.channels; ++channel) {
                const double value =
                    display.channels == 3 ? values[channel] : luminance(values, layer.channels);
                display.values[pixel * display.channels + channel] =
                    code(tone_curve(options.curve, value / white), threshold(x, y, channel));
            }
        }
    return display;
}

}  // namespace tyndall::render
