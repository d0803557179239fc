#include <png.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "mesh/input_error.h"
#include "render/png_file.h"
#include "render/tone_map.h"
#include "support/catch.h"

namespace {

using namespace tyndall;
using namespace tyndall::render;

Image constant_image(std::size_t size, std::vector<float> pixel) {
    Image image{size, size, {{"beauty", pixel.size(), {}}}};
    for (std::size_t at = 0; at < size * size; ++at)
        image.layers[0].values.insert(image.layers[0].values.end(), pixel.begin(), pixel.end());
    return image;
}

double mean(const std::vector<std::uint8_t>& codes) {
    return std::accumulate(codes.begin(), codes.end(), 0.0) / static_cast<double>(codes.size());
}

}  // namespace

TEST_CASE("the shoulder is linear, then smooth, then white") {
    CHECK(shoulder(-1.0) == 0.0);
    CHECK(shoulder(std::nan("")) == 0.0);
    CHECK(shoulder(0.1) == Approx(0.22));
    CHECK(shoulder(0.2) == Approx(0.44));
    CHECK(shoulder(1.0) == 1.0);
    CHECK(shoulder(std::numeric_limits<double>::infinity()) == 1.0);
    // Value and slope continue where the shoulder begins, at 0.6 / 2.2: the jump of a difference
    // quotient over 2h is of the order h.
    const double at = 0.6 / 2.2, h = 1e-6;
    CHECK((shoulder(at + h) - shoulder(at)) / h ==
          Approx((shoulder(at) - shoulder(at - h)) / h).epsilon(1e-4));
    double before = 0.0;
    for (double s = 0.01; s <= 1.0; s += 0.01) {
        CHECK(shoulder(s) > before);
        before = shoulder(s);
    }
}

TEST_CASE("sRGB codes of known light") {
    CHECK(srgb_encode(0.0) == 0.0);
    CHECK(srgb_encode(1.0) == Approx(1.0));
    CHECK(255.0 * srgb_encode(0.18) == Approx(117.6).margin(0.1));  // middle grey
    CHECK(255.0 * srgb_encode(0.5) == Approx(187.5).margin(0.1));
    CHECK(srgb_encode(0.0031308) == Approx(srgb_encode(0.00313081)).epsilon(1e-4));
}

TEST_CASE("an even picture is middle grey, whatever its radiance and unit") {
    for (const float radiance : {1e-6f, 0.3f, 2e5f}) {
        const auto display = tone_map(constant_image(64, {radiance}));
        CHECK(display.channels == 1);
        // Dithering averages out over 4096 pixels to a few thousandths of a code.
        CHECK(mean(display.values) == Approx(255.0 * srgb_encode(0.18)).margin(0.01));
    }
}

TEST_CASE("a few lamps and much darkness move the exposure little") {
    auto image = constant_image(100, {0.5f});
    const double plain = automatic_white(image, image.layers[0]);
    auto& values = image.layers[0].values;
    for (std::size_t at = 0; at < 50; ++at) values[at] = 5000.0f;  // 0.5 %: a lamp
    for (std::size_t at = 50; at < 5050; ++at) values[at] = 0.0f;  // half: outside
    // The lamp: e^(50/5000 ln 1e4) = 1.097.
    CHECK(automatic_white(image, image.layers[0]) == Approx(plain).epsilon(0.1));
    values[9999] = std::nanf("");
    CHECK(std::isfinite(automatic_white(image, image.layers[0])));
    CHECK(automatic_white(constant_image(4, {0.0f}), constant_image(4, {0.0f}).layers[0]) == 1.0);
}

TEST_CASE("dithering has no bias: the mean over few pixels is the exact code") {
    ToneMapOptions options;
    options.white = 1.0;
    for (const float radiance : {0.0f, 0.0123f, 0.1f, 0.2345f, 0.25f, 0.7f, 0.99f, 1.0f}) {
        const double exact = 255.0 * srgb_encode(shoulder(radiance));
        const auto display = tone_map(constant_image(128, {radiance}), options);
        // Discrepancy of N points of a good lattice: about log(N)/N = 6e-4 for N = 16384.
        CHECK(mean(display.values) == Approx(exact).margin(2e-3));
        for (const auto code : display.values) CHECK(std::abs(code - exact) < 1.0);
        double worst = 0.0;  // of the means of 8×8 pixels
        for (std::size_t y = 0; y < 128; y += 8)
            for (std::size_t x = 0; x < 128; x += 8) {
                double sum = 0.0;
                for (std::size_t j = 0; j < 8; ++j)
                    for (std::size_t i = 0; i < 8; ++i)
                        sum += display.values[(y + j) * 128 + x + i];
                worst = std::max(worst, std::abs(sum / 64.0 - exact));
            }
        // Independent random thresholds would give 4 standard errors of 0.5/8, 0.25.
        CHECK(worst < 0.08);
    }
}

TEST_CASE("a smooth ramp shows no bands: no run of equal codes as long as undithered") {
    Image ramp{512, 1, {{"beauty", 1, {}}}};
    for (std::size_t x = 0; x < 512; ++x)
        ramp.layers[0].values.push_back(0.1f + 0.002f * static_cast<float>(x) / 512.0f);
    ToneMapOptions options;
    options.white = 1.0;
    const auto display = tone_map(ramp, options);
    std::size_t longest = 0, run = 0;
    for (std::size_t x = 1; x < 512; ++x) {
        run = display.values[x] == display.values[x - 1] ? run + 1 : 0;
        longest = std::max(longest, run);
    }
    CHECK(longest < 100);  // a step of one code is 400 pixels wide here
}

TEST_CASE("three bands are a colour picture, other counts their mean in grey") {
    ToneMapOptions options;
    options.white = 2.0;
    const auto colour = tone_map(constant_image(2, {0.0f, 2.0f, 8.0f}), options);
    REQUIRE(colour.channels == 3);
    CHECK(colour.values[0] == 0);
    CHECK(colour.values[1] == 255);
    CHECK(colour.values[2] == 255);
    const auto grey = tone_map(constant_image(2, {0.0f, 4.0f, 1.0f, 3.0f}), options);
    REQUIRE(grey.channels == 1);
    CHECK(grey.values[0] == 255);
}

TEST_CASE("exposure is in stops, and bad values of pixels or options are caught") {
    ToneMapOptions options;
    options.white = 1.0;
    options.exposure = 2.0;
    const auto brighter = tone_map(constant_image(64, {0.05f}), options);
    options.exposure = 0.0;
    CHECK(mean(brighter.values) ==
          Approx(mean(tone_map(constant_image(64, {0.2f}), options).values)).margin(1e-9));
    const float inf = std::numeric_limits<float>::infinity();
    CHECK(tone_map(constant_image(1, {std::nanf("")}), options).values[0] == 0);
    CHECK(tone_map(constant_image(1, {-inf}), options).values[0] == 0);
    CHECK(tone_map(constant_image(1, {inf}), options).values[0] == 255);
    options.white = 0.0;
    CHECK_THROWS_AS(tone_map(constant_image(1, {1.0f}), options), mesh::InputError);
    options.white = 1.0;
    options.exposure = std::nan("");
    CHECK_THROWS_AS(tone_map(constant_image(1, {1.0f}), options), mesh::InputError);
}

TEST_CASE("PNG: what is written is read, and says that it is sRGB") {
    DisplayImage image{5, 3, 3, {}};
    for (int at = 0; at < 45; ++at) image.values.push_back(static_cast<std::uint8_t>(7 * at));
    const auto bytes = encode_png(image);
    CHECK(bytes.find("sRGB") != std::string::npos);
    CHECK(bytes.find("tIME") == std::string::npos);
    CHECK(bytes == encode_png(image));
    png_image read{};
    read.version = PNG_IMAGE_VERSION;
    REQUIRE(png_image_begin_read_from_memory(&read, bytes.data(), bytes.size()));
    CHECK(read.width == 5);
    CHECK(read.height == 3);
    CHECK(read.format == PNG_FORMAT_RGB);
    std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(read));
    REQUIRE(png_image_finish_read(&read, nullptr, pixels.data(), 0, nullptr));
    CHECK(pixels == image.values);
    CHECK_THROWS_AS(encode_png(DisplayImage{0, 0, 1, {}}), mesh::InputError);
}

TEST_CASE("Every tone curve goes up from 0 to 1 without a jump") {
    for (const ToneCurve curve :
         {ToneCurve::shoulder, ToneCurve::filmic, ToneCurve::reinhard, ToneCurve::linear}) {
        INFO(tone_curve_names()[static_cast<std::size_t>(curve)]);
        CHECK(tone_curve(curve, -1.0) == 0.0);
        CHECK(tone_curve(curve, 0.0) == 0.0);
        CHECK(tone_curve(curve, 1.0) == Approx(1.0));
        CHECK(tone_curve(curve, 50.0) == 1.0);
        double before = 0.0;
        for (int k = 1; k <= 1000; ++k) {
            const double now = tone_curve(curve, 0.001 * k);
            CHECK(now >= before);
            CHECK(now - before < 0.01);
            before = now;
        }
    }
    // Middle grey, 0.18 of the linear part: what each makes of it, by hand from the equations.
    const double grey = 0.18 / 2.2;
    CHECK(tone_curve(ToneCurve::linear, grey) == Approx(0.18));
    CHECK(tone_curve(ToneCurve::shoulder, grey) == Approx(0.18));
    CHECK(tone_curve(ToneCurve::reinhard, grey) == Approx(0.15821).epsilon(1e-4));
    CHECK(tone_curve(ToneCurve::filmic, grey) == Approx(0.28432).epsilon(1e-3));
    CHECK(tone_curve(ToneCurve::linear, 0.5) == 1.0);
}
