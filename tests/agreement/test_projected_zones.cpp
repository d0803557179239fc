// Projected zones show what the line of sight does, but for where a sub-pixel's middle falls.
#include <limits>

#include "mesh/input_error.h"
#include "radiosity/adaptive.h"
#include "render/compare.h"
#include "render/line_of_sight.h"
#include "render/projected_zones.h"
#include "support/catch.h"
#include "support/path_scenes.h"

using namespace tyndall;

namespace {

render::Camera towards_slit() {
    return test::camera_at({0.4, 0.3, 1.2}, {3.0, 1.6, 1.4}, 1.3, 64, 48);
}

const radiosity::Solution& slit_solution() {
    static const radiosity::Solution solution = radiosity::solve_adaptively(
        std::make_shared<const radiosity::Enclosure>(radiosity::make_enclosure(test::slit_room())),
        {.error = 0.1,
         .start = radiosity::Start::base,
         .max_elements = 3000,
         .rays = 16,
         .gather_rays = 16},
        towards_slit().view());
    return solution;
}

double block_error_of(const render::Image& a, const render::Image& b, const std::string& layer) {
    return render::block_error(a.width, a.height, *a.find(layer), *b.find(layer), 8);
}

}  // namespace

TEST_CASE("Projected zones agree with the line of sight, layer by layer", "[projected_zones]") {
    const auto camera = towards_slit();
    // What zones hold, as projected_zones shows it: no ray looks at single scattering anew.
    const auto walked = render::line_of_sight(
        slit_solution(), camera, {.samples = 64, .scattering_tolerance = render::as_elements_hold});
    const auto projected = render::projected_zones(slit_solution(), camera, {.samples = 64});
    // Media have no edges in a picture: lines through the same zones, at other places of a pixel.
    // Surfaces have, and an edge is placed to an eighth of a pixel.
    CHECK(block_error_of(projected, walked, "transmittance") < 0.001);
    CHECK(block_error_of(projected, walked, "multiple_scattering") < 0.001);
    CHECK(block_error_of(projected, walked, "single_scattering") < 0.004);
    CHECK(block_error_of(projected, walked, "beauty") < 0.01);
    const auto finer = render::projected_zones(slit_solution(), camera, {.samples = 256});
    CHECK(block_error_of(finer, walked, "beauty") < 0.01);
    // A part of the picture is that part, and threads change no bit.
    const auto part = render::projected_zones(slit_solution(), camera.cropped(16, 8, 20, 24),
                                              {.samples = 16, .threads = 1});
    const auto whole = render::projected_zones(slit_solution(), camera, {.samples = 16});
    const auto cut = render::region_of(64, 48, *whole.find("beauty"), {16, 8, 20, 24});
    // Where a tile of sub-pixels begins moves a middle by its rounding, which an edge can show.
    CHECK(render::block_error(20, 24, *part.find("beauty"), cut, 1) < 0.01);
    const auto again =
        render::projected_zones(slit_solution(), camera, {.samples = 16, .threads = 1});
    CHECK(again.find("beauty")->values == whole.find("beauty")->values);
}

TEST_CASE("Projected zones refuse what is no plane perspective", "[projected_zones]") {
    auto camera = towards_slit();
    camera.lens = render::Lens{0.1, 2.0};
    CHECK_THROWS_WITH(render::projected_zones(slit_solution(), camera),
                      Contains("perspective pictures without a lens"));
    camera.lens.reset();
    camera.projection = radiosity::PictureProjection::panorama;
    CHECK_THROWS_WITH(render::projected_zones(slit_solution(), camera),
                      Contains("perspective pictures without a lens"));
}
