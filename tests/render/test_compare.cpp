#include <cmath>
#include <limits>

#include "mesh/input_error.h"
#include "render/compare.h"
#include "support/catch.h"

namespace {

using namespace tyndall;
using namespace tyndall::render;

Layer constant(std::size_t values, float value, std::size_t channels = 1) {
    return {"beauty", channels, std::vector<float>(values, value)};
}

}  // namespace

TEST_CASE("a picture does not differ from itself") {
    auto layer = constant(20 * 10, 2.0f);
    for (std::size_t at = 0; at < layer.values.size(); ++at) layer.values[at] = 0.1f * at;
    const auto error = compare(20, 10, layer, layer);
    CHECK(error.rmse == 0.0);
    CHECK(error.bias == 0.0);
    CHECK(error.block4 == 0.0);
    CHECK(error.block16 == 0.0);
    CHECK(error.max_error == 0.0);
    CHECK(error.mean == error.reference_mean);
}

TEST_CASE("an even offset is the same error at every block size") {
    const auto error = compare(32, 32, constant(1024, 2.5f), constant(1024, 2.0f));
    CHECK(error.bias == Approx(0.25));
    CHECK(error.rmse == Approx(0.25));
    CHECK(error.block4 == Approx(0.25));
    CHECK(error.block16 == Approx(0.25));
}

TEST_CASE("a checkerboard averages out in blocks") {
    auto picture = constant(32 * 32, 0.0f);
    for (std::size_t y = 0; y < 32; ++y)
        for (std::size_t x = 0; x < 32; ++x) picture.values[32 * y + x] = (x + y) % 2 ? 3.0f : 1.0f;
    const auto error = compare(32, 32, picture, constant(32 * 32, 2.0f));
    CHECK(error.rmse == Approx(0.5));  // |1| / 2
    CHECK(error.block4 == Approx(0.0).margin(1e-15));
    CHECK(error.bias == Approx(0.0).margin(1e-15));
}

TEST_CASE("one wrong pixel, by hand") {
    // 8 × 4 pixels are two blocks of 4 × 4; the reference is 1 on the left and 3 on the right:
    // mean 2.
    auto reference = constant(32, 1.0f);
    for (std::size_t y = 0; y < 4; ++y)
        for (std::size_t x = 4; x < 8; ++x) reference.values[8 * y + x] = 3.0f;
    auto picture = reference;
    picture.values[8 * 2 + 5] += 8.0f;
    const auto error = compare(8, 4, picture, reference);
    CHECK(error.rmse == Approx(std::sqrt(64.0 / 32.0) / 2.0));
    CHECK(error.block4 ==
          Approx(std::sqrt(0.5 * 0.5 * 0.5) / 2.0));     // one of two blocks is off by 8/16
    CHECK(error.block16 == Approx((8.0 / 32.0) / 2.0));  // one block, cut off
    CHECK(error.bias == Approx((8.0 / 32.0) / 2.0));
    CHECK(error.max_error == Approx(4.0));
    CHECK(error.max_x == 5);
    CHECK(error.max_y == 2);
}

TEST_CASE("blocks cut off by the edge count by their pixels") {
    // 5 × 1: a block of four pixels and one of one pixel.
    const auto reference = constant(5, 1.0f);
    auto picture = reference;
    picture.values[4] = 2.0f;
    CHECK(block_error(5, 1, picture, reference, 4) == Approx(std::sqrt(1.0 / 5.0)));
    picture = reference;
    picture.values[0] = 2.0f;
    CHECK(block_error(5, 1, picture, reference, 4) == Approx(std::sqrt(4.0 / 16.0 / 5.0)));
}

TEST_CASE("channels are compared one by one, relative to the mean of all") {
    // The same sum in every pixel, but red and blue exchanged.
    Layer picture{"beauty", 3, {}}, reference{"beauty", 3, {}};
    for (int at = 0; at < 16; ++at) {
        picture.values.insert(picture.values.end(), {1.0f, 2.0f, 3.0f});
        reference.values.insert(reference.values.end(), {3.0f, 2.0f, 1.0f});
    }
    const auto error = compare(4, 4, picture, reference);
    CHECK(error.bias == Approx(0.0).margin(1e-15));
    CHECK(error.rmse == Approx(std::sqrt(8.0 / 3.0) / 2.0));
    CHECK(error.block4 == Approx(error.rmse));
}

TEST_CASE("values that are not finite or negative are counted") {
    const auto reference = constant(64, 1.0f);
    auto picture = reference;
    picture.values[0] = std::nanf("");
    picture.values[9] = std::numeric_limits<float>::infinity();
    picture.values[63] = -1.0f;
    const auto error = compare(8, 8, picture, reference);
    CHECK(error.not_finite == 2);
    CHECK(error.negative == 1);
    CHECK(std::isfinite(error.rmse));
    CHECK(error.max_error == Approx(2.0));
    CHECK_THROWS_WITH(compare(8, 8, reference, picture),
                      Contains("reference") && Contains("finite"));
}

TEST_CASE("what cannot be compared is refused") {
    CHECK_THROWS_WITH(compare(2, 2, constant(4, 1.0f), constant(12, 1.0f, 3)),
                      Contains("1 channels") && Contains("3"));
    CHECK_THROWS_AS(compare(2, 2, constant(4, 1.0f), constant(6, 1.0f)), mesh::InputError);
    CHECK_THROWS_WITH(compare(2, 2, constant(4, 1.0f), constant(4, 0.0f)), Contains("mean is 0"));
    CHECK(compare(2, 2, constant(4, 0.0f), constant(4, 0.0f)).rmse == 0.0);
    CHECK_THROWS_AS(block_error(2, 2, constant(4, 1.0f), constant(4, 1.0f), 0), mesh::InputError);
}

TEST_CASE(
    "the difference picture is red where too bright, blue where too dark, white where equal") {
    const auto reference = constant(4, 1.0f);
    Layer picture{"beauty", 1, {1.0f, 3.0f, 0.5f, std::nanf("")}};
    const auto display = difference_picture(2, 2, picture, reference, 1.0);
    const std::vector<std::uint8_t> expected{255, 255, 255, 255, 0,   0,
                                             128, 128, 255, 128, 128, 128};
    CHECK(display.values == expected);
    CHECK(difference_range(reference, reference) == 1.0);
    CHECK_THROWS_AS(difference_picture(2, 2, picture, reference, 0.0), mesh::InputError);
}

TEST_CASE("MAPE weighs dark places as bright ones, but for what is nearly black") {
    // A tenth too bright everywhere, and 1 where the reference is black: of 1 % of the mean, 25.
    const Layer reference{"beauty", 1, {0.0f, 1.0f, 10.0f, 89.0f}};
    Layer picture{"beauty", 1, {0.0f, 1.1f, 11.0f, 97.9f}};
    const double floor = 0.25;
    const double tenth =
        0.1 * (1.0 / (1.0 + floor) + 10.0 / (10.0 + floor) + 89.0 / (89.0 + floor));
    CHECK(compare(2, 2, picture, reference).mape == Approx(tenth / 4.0));
    picture.values[0] = 1.0f;
    CHECK(compare(2, 2, picture, reference).mape == Approx((tenth + 1.0 / floor) / 4.0));
    picture.values[0] = std::nanf("");
    CHECK(compare(2, 2, picture, reference).mape == Approx(tenth / 3.0));
}

TEST_CASE("A region is the pixels it says") {
    Layer layer{"beauty", 2, {}};
    for (int k = 0; k < 4 * 3 * 2; ++k) layer.values.push_back(float(k));
    const Layer part = region_of(4, 3, layer, {1, 1, 2, 2});
    CHECK(part.channels == 2);
    CHECK(part.values == std::vector<float>{10, 11, 12, 13, 18, 19, 20, 21});
    CHECK_THROWS_WITH(region_of(4, 3, layer, {3, 0, 2, 1}), Contains("Give a part"));
    CHECK_THROWS_WITH(region_of(4, 3, layer, {0, 3, 1, 1}), Contains("Give a part"));
}
