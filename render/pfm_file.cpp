#include "render/pfm_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "mesh/input_error.h"

namespace tyndall::render {

namespace {

using mesh::InputError;

constexpr std::size_t max_side = 1u << 20;

struct Header {
    std::size_t channels = 1, width = 0, height = 0;
    double scale = -1.0;     // its sign tells the byte order: negative is little endian
    std::size_t pixels = 0;  // where they start
};

// The next word; `at` moves behind it and the one white space that ends it.
std::string_view next_word(std::string_view bytes, std::size_t& at) {
    const auto space = [](char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; };
    while (at < bytes.size() && space(bytes[at])) ++at;
    const auto begin = at;
    while (at < bytes.size() && !space(bytes[at]) && at - begin < 40) ++at;
    const auto word = bytes.substr(begin, at - begin);
    if (at < bytes.size()) ++at;
    return word;
}

template <class Number>
Number parse(std::string_view word, const char* what) {
    Number number{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size())
        throw InputError(fmt::format("its header has no valid {}", what));
    return number;
}

Header parse_header(std::string_view bytes) {
    Header header;
    std::size_t at = 0;
    const auto magic = next_word(bytes, at);
    if (magic != "Pf" && magic != "PF")
        throw InputError("it is not a PFM file (one begins with Pf or PF)");
    header.channels = magic == "PF" ? 3 : 1;
    header.width = parse<std::size_t>(next_word(bytes, at), "width");
    header.height = parse<std::size_t>(next_word(bytes, at), "height");
    header.scale = parse<double>(next_word(bytes, at), "scale");
    header.pixels = at;
    if (header.width == 0 || header.height == 0 || header.width > max_side ||
        header.height > max_side)
        throw InputError(
            fmt::format("its header says {} × {} pixels", header.width, header.height));
    if (!std::isfinite(header.scale) || header.scale == 0.0)
        throw InputError(fmt::format("its header has the scale {}", header.scale));
    return header;
}

void swap_bytes(std::vector<float>& values) {
    for (auto& value : values) {
        const auto bits = std::bit_cast<std::uint32_t>(value);
        value = std::bit_cast<float>(__builtin_bswap32(bits));
    }
}

}  // namespace

std::string encode_pfm(const Image& image, const Layer& layer) {
    if (layer.channels != 1 && layer.channels != 3)
        throw InputError(
            fmt::format("a PFM file has one channel or three, and layer '{}' has {}. "
                        "Write an EXR file (.exr)",
                        layer.name, layer.channels));
    const std::size_t row = image.width * layer.channels;
    std::string bytes = fmt::format("{}\n{} {}\n-1.0\n", layer.channels == 3 ? "PF" : "Pf",
                                    image.width, image.height);
    bytes.reserve(bytes.size() + row * image.height * sizeof(float));
    std::vector<float> line(row);
    for (std::size_t y = image.height; y-- > 0;) {
        std::copy_n(layer.values.begin() + static_cast<std::ptrdiff_t>(y * row), row, line.begin());
        if constexpr (std::endian::native == std::endian::big) swap_bytes(line);
        bytes.append(reinterpret_cast<const char*>(line.data()), row * sizeof(float));
    }
    return bytes;
}

Image decode_pfm(std::string_view bytes) {
    const Header header = parse_header(bytes);
    const std::size_t row = header.width * header.channels;
    const std::size_t expected = row * header.height * sizeof(float);
    const std::size_t found = bytes.size() - header.pixels;
    if (found != expected)
        throw InputError(fmt::format("it has {} bytes of pixels where its header says {}: {}",
                                     found, expected,
                                     found < expected ? "it is cut short" : "it is damaged"));
    Image image{header.width, header.height, {{"beauty", header.channels, {}}}};
    auto& values = image.layers[0].values;
    values.resize(row * header.height);
    for (std::size_t y = 0; y < header.height; ++y)
        std::memcpy(values.data() + (header.height - 1 - y) * row,
                    bytes.data() + header.pixels + y * row * sizeof(float), row * sizeof(float));
    const bool little = header.scale < 0.0;
    if (little != (std::endian::native == std::endian::little)) swap_bytes(values);
    if (const auto scale = static_cast<float>(std::abs(header.scale)); scale != 1.0f)
        for (auto& value : values) value *= scale;
    return image;
}

}  // namespace tyndall::render
