#include "render/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "mesh/input_error.h"

namespace tyndall::render {

namespace {

constexpr std::array<const char*, 3> direct_single_parts{"emission", "surfaces_direct",
                                                         "single_scattering"};

std::string names_of(const Image& image) {
    std::string names;
    for (const auto& layer : image.layers) names += (names.empty() ? "" : ", ") + layer.name;
    return names.empty() ? "none" : names;
}

const Layer& require(const Image& image, const std::string& name, const std::string& asked) {
    if (const auto* layer = image.find(name)) return *layer;
    const std::string part = name == asked ? "" : fmt::format(" (a part of '{}')", asked);
    throw mesh::InputError(
        fmt::format("the picture has no layer '{}'{}. It has: {}.", name, part, names_of(image)));
}

Layer sum_of_direct_single(const Image& image) {
    Layer sum = require(image, direct_single_parts[0], "direct_single");
    sum.name = "direct_single";
    for (std::size_t part = 1; part < direct_single_parts.size(); ++part) {
        const auto& layer = require(image, direct_single_parts[part], sum.name);
        if (layer.channels != sum.channels)
            throw mesh::InputError(
                fmt::format("layers '{}' and '{}' have {} and {} channels: they cannot be summed.",
                            direct_single_parts[0], layer.name, sum.channels, layer.channels));
        std::transform(sum.values.begin(), sum.values.end(), layer.values.begin(),
                       sum.values.begin(), std::plus<>());
    }
    return sum;
}

}  // namespace

const Layer* Image::find(const std::string& name) const {
    const auto found = std::find_if(layers.begin(), layers.end(),
                                    [&](const Layer& layer) { return layer.name == name; });
    return found == layers.end() ? nullptr : &*found;
}

Layer select_layer(const Image& image, const std::string& name) {
    if (name.empty() && !image.layers.empty()) return image.layers.front();
    if (name == "direct_single" && image.find(name) == nullptr) return sum_of_direct_single(image);
    return require(image, name, name);
}

void check_sizes(const Image& image) {
    if (image.layers.empty() || image.width == 0 || image.height == 0)
        throw std::logic_error("an image without pixels or layers");
    for (const auto& layer : image.layers)
        if (layer.channels == 0 ||
            layer.values.size() != image.width * image.height * layer.channels)
            throw std::logic_error(fmt::format("layer '{}' has {} values, not {} × {} × {}",
                                               layer.name, layer.values.size(), image.width,
                                               image.height, layer.channels));
}

}  // namespace tyndall::render
