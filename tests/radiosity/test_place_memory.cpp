// Values at places, found again.
#include "radiosity/place_memory.h"

#include <array>

#include "support/catch.h"

using namespace tyndall;
using namespace tyndall::radiosity;

TEST_CASE("A place is found by its bits, with its normal") {
    PlaceMemory memory(2);
    const std::array<double, 2> first{1.0, 2.0}, second{3.0, 4.0};
    memory.keep({0.1, 0.2, 0.3}, {0, 0, 0}, first);
    memory.keep({0.1, 0.2, 0.3}, {0, 0, 1}, second);
    CHECK(!memory.find({0.1, 0.2, 0.3}, {0, 0, 0}));  // not before it has settled
    memory.settle();
    REQUIRE(memory.find({0.1, 0.2, 0.3}, {0, 0, 0}));
    CHECK(memory.find({0.1, 0.2, 0.3}, {0, 0, 0})[1] == 2.0);
    CHECK(memory.find({0.1, 0.2, 0.3}, {0, 0, 1})[1] == 4.0);
    CHECK(!memory.find({0.1, 0.2, 0.3 + 1e-16}, {0, 1, 0}));
    CHECK(memory.places() == 2);
}

TEST_CASE("What is found at a place does not depend on who kept it first") {
    // As two samples that a body has moved to one place: each has found its own.
    const std::array<double, 2> one{1.0, 7.0}, other{1.0, 5.0};
    PlaceMemory forth(2), back(2);
    forth.keep({1, 2, 3}, {0, 0, 0}, one);
    forth.keep({1, 2, 3}, {0, 0, 0}, other);
    back.keep({1, 2, 3}, {0, 0, 0}, other);
    back.keep({1, 2, 3}, {0, 0, 0}, one);
    forth.settle();
    back.settle();
    CHECK(forth.find({1, 2, 3}, {0, 0, 0})[1] == 5.0);
    CHECK(back.find({1, 2, 3}, {0, 0, 0})[1] == 5.0);
}
