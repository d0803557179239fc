// Hilbert's curve in three dimensions: neighbours along it are neighbours in space.
#pragma once

#include <array>
#include <cstdint>

namespace tyndall::mesh {

// Position along the curve of a cell with coordinates below 2^bits, bits <= 21.
// Source: Skilling, "Programming the Hilbert curve", AIP Conf. Proc. 707 (2004).
constexpr std::uint64_t hilbert_index(std::array<std::uint32_t, 3> x, int bits) {
    for (std::uint32_t q = 1u << (bits - 1); q > 1; q >>= 1) {
        const std::uint32_t p = q - 1;
        for (auto& coordinate : x) {
            if (coordinate & q) {
                x[0] ^= p;
            } else {
                const std::uint32_t t = (x[0] ^ coordinate) & p;
                x[0] ^= t;
                coordinate ^= t;
            }
        }
    }
    x[1] ^= x[0];
    x[2] ^= x[1];
    std::uint32_t t = 0;
    for (std::uint32_t q = 1u << (bits - 1); q > 1; q >>= 1) {
        if (x[2] & q) {
            t ^= q - 1;
        }
    }
    std::uint64_t index = 0;
    for (int bit = bits - 1; bit >= 0; --bit) {
        for (const auto coordinate : x) {
            index = index << 1 | (((coordinate ^ t) >> bit) & 1u);
        }
    }
    return index;
}

}  // namespace tyndall::mesh
