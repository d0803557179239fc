// Random numbers for paths: one independent stream a pixel and sample.
#pragma once

#include <cstdint>

#include "radiosity/point_set.h"

namespace tyndall::render {

// PCG-XSH-RR 64/32. Source: O'Neill (2014).
class RandomNumbers {
  public:
    RandomNumbers(std::uint64_t seed, std::uint64_t stream)
        : state_(radiosity::hash_seed(seed, stream)) {
        next();
    }

    // Uniform in [0, 1), with 32 bits.
    double operator()() { return next() * 0x1p-32; }

  private:
    std::uint32_t next() {
        const std::uint64_t old = state_;
        state_ = old * 6364136223846793005ull + 1442695040888963407ull;
        const auto xored = static_cast<std::uint32_t>(((old >> 18) ^ old) >> 27);
        const auto turn = static_cast<std::uint32_t>(old >> 59);
        return (xored >> turn) | (xored << ((32 - turn) & 31));
    }

    std::uint64_t state_;
};

}  // namespace tyndall::render
