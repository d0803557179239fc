// What each exchange method holds by its nature, between the sides and media of five scenes: open
// and closed, empty, of one medium and of two, with an occluder and with a slit.
#include "cli/scene_file.h"
#include "radiosity/exchange_table.h"
#include "support/catch.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

const std::vector<std::string> scenes{"three_squares", "foggy_cube", "two_media_screen",
                                      "shaft_box", "tiny_lamp"};

ExchangeTable table_of(const std::string& scene, const std::string& method,
                       const ExchangeOptions& options) {
    const auto file = cli::read_scene_file(TYNDALL_SOURCE_DIR "/tests/scenes/" + scene + ".toml");
    const auto enclosure = make_enclosure(file.scene);
    const auto names = exchange_names(enclosure);
    return exchange_table(enclosure, exchange_method(method), options, names, names);
}

}  // namespace

TEST_CASE("Walked rows and rows by cubes close, whatever the rays and pixels", "[exchange]") {
    for (const auto& scene : scenes) {
        INFO(scene);
        CHECK(table_of(scene, "walked", {.rays = 16}).closure_error < 1e-12);
        // Pixels' weights are in double precision; their sum over a cube is that of a few thousand.
        CHECK(table_of(scene, "full_cube",
                       {.settings = {.resolution = 16, .projection = Projection::walked}})
                  .closure_error < 1e-12);
    }
}

TEST_CASE("Pairs are reciprocal, and rows close as their entries are right", "[exchange][long]") {
    for (const auto& scene : scenes) {
        INFO(scene);
        const auto traced = table_of(scene, "ray_traced_pairs", {.settings = {.tolerance = 0.05}});
        CHECK(traced.reciprocity_error < 1e-14);
        CHECK(traced.closure_error < 0.05);
        const auto exact = table_of(scene, "reference_pairs", {.settings = {.tolerance = 5e-3}});
        CHECK(exact.reciprocity_error < 1e-14);
        CHECK(exact.closure_error < 5e-3);
    }
}

TEST_CASE("Contours close a room that nothing stands in", "[exchange]") {
    const auto file = cli::read_scene_file(TYNDALL_SOURCE_DIR "/tests/scenes/foggy_cube.toml",
                                           {"medium.haze.extinction=0"});
    const auto enclosure = make_enclosure(file.scene);
    std::vector<std::string> sides = exchange_names(enclosure);
    const auto table =
        exchange_table(enclosure, exchange_method("contour_integration"), {}, sides, sides);
    CHECK(table.closure_error < 1e-13);
    CHECK(table.reciprocity_error < 1e-14);
}
