#include "render/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mesh/input_error.h"

namespace tyndall::render {

namespace {

using mesh::InputError;

void check_pair(std::size_t width, std::size_t height, const Layer& picture,
                const Layer& reference) {
    if (picture.channels != reference.channels)
        throw InputError(
            fmt::format("the picture's layer '{}' has {} channels and the reference's '{}' has {}. "
                        "Compare layers with the same bands.",
                        picture.name, picture.channels, reference.name, reference.channels));
    const std::size_t count = width * height * picture.channels;
    if (count == 0 || picture.values.size() != count || reference.values.size() != count)
        throw InputError(fmt::format(
            "the picture has {} values and the reference {}, where {} × {} pixels of {} "
            "channels are to be compared.",
            picture.values.size(), reference.values.size(), width, height, picture.channels));
}

double mean_of_finite(const Layer& layer) {
    double sum = 0.0;
    std::size_t count = 0;
    for (const float value : layer.values) {
        if (!std::isfinite(value)) continue;
        sum += value;
        ++count;
    }
    return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

double reference_mean(const Layer& reference) {
    for (const float value : reference.values)
        if (!std::isfinite(value))
            throw InputError(
                fmt::format("the reference's layer '{}' has a value that is not finite "
                            "({}): nothing can be compared with it.",
                            reference.name, value));
    return mean_of_finite(reference);
}

// An error in units of the reference's mean. Two black pictures do not differ.
double relative(double error, double mean) {
    if (error == 0.0) return 0.0;
    if (!(std::abs(mean) > 0.0))
        throw InputError(
            "the reference's mean is 0 and the picture differs from it: a relative "
            "error has no meaning. Choose another layer or reference.");
    return error / mean;
}

struct Sums {
    double squares = 0.0;  // weighted by pixels
    double pixels = 0.0;
};

void add_block(Sums& sums, std::size_t width, const Layer& picture, const Layer& reference,
               std::size_t x0, std::size_t x1, std::size_t y0, std::size_t y1) {
    const auto pixels = static_cast<double>((x1 - x0) * (y1 - y0));
    for (std::size_t channel = 0; channel < picture.channels; ++channel) {
        double difference = 0.0;
        for (std::size_t y = y0; y < y1; ++y)
            for (std::size_t x = x0; x < x1; ++x) {
                const std::size_t at = (y * width + x) * picture.channels + channel;
                difference += static_cast<double>(picture.values[at]) - reference.values[at];
            }
        if (!std::isfinite(difference)) continue;
        sums.squares += difference * difference / pixels;  // pixels · (difference / pixels)²
        sums.pixels += pixels;
    }
}

// Absolute.
double block_rms(std::size_t width, std::size_t height, const Layer& picture,
                 const Layer& reference, std::size_t n) {
    Sums sums;
    for (std::size_t y = 0; y < height; y += n)
        for (std::size_t x = 0; x < width; x += n)
            add_block(sums, width, picture, reference, x, std::min(x + n, width), y,
                      std::min(y + n, height));
    return sums.pixels > 0.0 ? std::sqrt(sums.squares / sums.pixels) : 0.0;
}

// Mean of |p − r| / (|r| + 0.01 mean |r|), over what is finite. Two black pictures do not differ.
double mean_share(const Layer& picture, const Layer& reference) {
    double floor = 0.0, sum = 0.0;
    for (const float value : reference.values) floor += std::abs(double(value));
    floor *= 0.01 / static_cast<double>(reference.values.size());
    std::size_t count = 0;
    for (std::size_t at = 0; at < picture.values.size(); ++at) {
        if (!std::isfinite(picture.values[at])) continue;
        const double of = reference.values[at], off = std::abs(double(picture.values[at]) - of);
        sum += off > 0.0 ? off / (std::abs(of) + floor) : 0.0;
        ++count;
    }
    return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

// Mean over the channels of picture − reference.
double pixel_difference(const Layer& picture, const Layer& reference, std::size_t pixel) {
    double sum = 0.0;
    for (std::size_t channel = 0; channel < picture.channels; ++channel) {
        const std::size_t at = pixel * picture.channels + channel;
        sum += static_cast<double>(picture.values[at]) - reference.values[at];
    }
    return sum / static_cast<double>(picture.channels);
}

}  // namespace

double block_error(std::size_t width, std::size_t height, const Layer& picture,
                   const Layer& reference, std::size_t n) {
    check_pair(width, height, picture, reference);
    if (n == 0) throw InputError("a block of 0 × 0 pixels is empty. Give at least 1.");
    return relative(block_rms(width, height, picture, reference, n), reference_mean(reference));
}

PictureError compare(std::size_t width, std::size_t height, const Layer& picture,
                     const Layer& reference) {
    check_pair(width, height, picture, reference);
    PictureError error;
    error.reference_mean = reference_mean(reference);
    error.mean = mean_of_finite(picture);
    double largest = 0.0;
    for (std::size_t at = 0; at < picture.values.size(); ++at) {
        const double value = picture.values[at];
        error.negative += value < 0.0 ? 1 : 0;
        error.not_finite += std::isfinite(value) ? 0 : 1;
        const double difference = std::abs(value - reference.values[at]);
        if (!(difference > largest) || !std::isfinite(difference)) continue;
        largest = difference;
        error.max_x = at / picture.channels % width;
        error.max_y = at / picture.channels / width;
    }
    const auto blocks = [&](std::size_t n) {
        return relative(block_rms(width, height, picture, reference, n), error.reference_mean);
    };
    error.rmse = blocks(1);
    error.block4 = blocks(4);
    error.block16 = blocks(16);
    error.bias = relative(error.mean - error.reference_mean, error.reference_mean);
    error.max_error = relative(largest, error.reference_mean);
    error.mape = mean_share(picture, reference);
    return error;
}

Layer region_of(std::size_t width, std::size_t height, const Layer& layer, const Region& region) {
    if (region.width == 0 || region.height == 0 || region.left >= width ||
        region.width > width - region.left || region.top >= height ||
        region.height > height - region.top)
        throw InputError(fmt::format(
            "there are no {} × {} pixels from pixel ({}, {}) of a picture of {} × {}. Give a part "
            "of it.",
            region.width, region.height, region.left, region.top, width, height));
    Layer part{layer.name, layer.channels, {}};
    part.values.reserve(region.width * region.height * layer.channels);
    for (std::size_t y = region.top; y < region.top + region.height; ++y) {
        const auto row = layer.values.begin() +
                         static_cast<std::ptrdiff_t>((y * width + region.left) * layer.channels);
        part.values.insert(part.values.end(), row,
                           row + static_cast<std::ptrdiff_t>(region.width * layer.channels));
    }
    return part;
}

DisplayImage difference_picture(std::size_t width, std::size_t height, const Layer& picture,
                                const Layer& reference, double range) {
    check_pair(width, height, picture, reference);
    if (!(range > 0.0 && std::isfinite(range)))
        throw InputError(fmt::format(
            "the range of the difference picture is {}. Give a positive number.", range));
    DisplayImage display{width, height, 3, std::vector<std::uint8_t>(width * height * 3, 128)};
    for (std::size_t pixel = 0; pixel < width * height; ++pixel) {
        const double part = pixel_difference(picture, reference, pixel) / range;
        if (!std::isfinite(part)) continue;
        const double size = std::min(std::abs(part), 1.0);
        const auto faded = static_cast<std::uint8_t>(std::lround(255.0 * (1.0 - size)));
        auto* rgb = &display.values[3 * pixel];
        rgb[0] = part >= 0.0 ? 255 : faded;
        rgb[1] = faded;
        rgb[2] = part <= 0.0 ? 255 : faded;
    }
    return display;
}

double difference_range(const Layer& picture, const Layer& reference) {
    std::vector<double> sizes;
    const std::size_t pixels = picture.values.size() / picture.channels;
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        const double size = std::abs(pixel_difference(picture, reference, pixel));
        if (std::isfinite(size)) sizes.push_back(size);
    }
    if (sizes.empty()) return 1.0;
    const auto rank = static_cast<std::ptrdiff_t>(0.995 * static_cast<double>(sizes.size() - 1));
    std::nth_element(sizes.begin(), sizes.begin() + rank, sizes.end());
    return sizes[static_cast<std::size_t>(rank)] > 0.0 ? sizes[static_cast<std::size_t>(rank)]
                                                       : 1.0;
}

}  // namespace tyndall::render
