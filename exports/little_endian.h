// Numbers as bytes of a file, lowest byte first on any machine.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <type_traits>

namespace tyndall::exports {

template <class Number>
void append(std::string& bytes, Number number) {
    if constexpr (std::is_same_v<Number, float>) {
        append(bytes, std::bit_cast<std::uint32_t>(number));
    } else if constexpr (std::is_same_v<Number, double>) {
        append(bytes, std::bit_cast<std::uint64_t>(number));
    } else {
        const auto bits = static_cast<std::make_unsigned_t<Number>>(number);
        for (std::size_t k = 0; k < sizeof(Number); ++k)
            bytes += static_cast<char>(bits >> (8 * k) & 255u);
    }
}

}  // namespace tyndall::exports
