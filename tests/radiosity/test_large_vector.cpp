#include "radiosity/large_vector.h"

#include <cstdint>
#include <new>

#include "support/catch.h"

using tyndall::radiosity::LargeVector;

TEST_CASE("Large vectors keep their values as they grow", "[large_vector]") {
    LargeVector<std::uint32_t> values;
    constexpr std::uint32_t count = 3 << 20;  // from some bytes to several huge pages
    for (std::uint32_t k = 0; k < count; ++k) values.push_back(7 * k);
    const LargeVector<std::uint32_t> copy = values;
    values.resize(count + 5);
    values.shrink_to_fit();
    bool same = copy.size() == count && values.size() == count + 5;
    for (std::uint32_t k = 0; k < count; ++k) same = same && values[k] == 7 * k && copy[k] == 7 * k;
    CHECK(same);
    CHECK(reinterpret_cast<std::uintptr_t>(values.data()) % (2 << 20) == 0);
    CHECK(LargeVector<float>(3, 1.5f) == LargeVector<float>{1.5f, 1.5f, 1.5f});
}

TEST_CASE("Large vectors that no memory holds are refused", "[large_vector]") {
    LargeVector<double> values;
    CHECK_THROWS_AS(values.reserve(values.max_size()), std::bad_alloc);
}
