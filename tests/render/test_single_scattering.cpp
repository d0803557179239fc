// Single scattering where elements are too coarse for it, against small steps along every ray.
#include "render/single_scattering.h"

#include <limits>

#include "radiosity/adaptive.h"
#include "render/compare.h"
#include "render/line_of_sight.h"
#include "support/catch.h"
#include "support/marched_picture.h"
#include "support/path_scenes.h"

using namespace tyndall;

namespace {

constexpr std::size_t width = 20, height = 15;

render::Camera beside_the_cone() {
    return test::camera_at({0.3, 0.4, 1.5}, {2.2, 2.2, 1.7}, 1.2, width, height);
}

// A cone of light that passes the eye, in haze: rays run along its edge.
radiosity::Scene spot_in_haze() {
    auto scene = test::floor_room(0.5);
    scene.media = {test::medium(0.4, 0.9)};
    scene.lights = {{.source = radiosity::SpotLight{.position = {3.7, 0.6, 2.6},
                                                    .direction = {-1.8, 1.5, -1.4},
                                                    .intensity = {100.0},
                                                    .angle = 0.87,
                                                    .soft_edge = 0.09}}};
    return scene;
}

render::PictureError error_of(const radiosity::Solution& solution, const render::Layer& exact,
                              std::size_t samples, double tolerance) {
    const auto image = render::line_of_sight(
        solution, beside_the_cone(), {.samples = samples, .scattering_tolerance = tolerance});
    return render::compare(width, height, render::select_layer(image, "direct_single"), exact);
}

}  // namespace

TEST_CASE("Single scattering on zones that are too coarse is looked at along rays", "[picture]") {
    const auto scene = GENERATE(spot_in_haze(), test::slit_room());
    const auto solution = radiosity::solve_adaptively(
        test::enclosed(scene),
        {.refinement = radiosity::Refinement::none, .rays = 16, .gather_rays = 4});
    const std::size_t samples = GENERATE(1, 8);
    const auto exact = test::marched_picture(*solution.enclosure, beside_the_cone(), samples, 0.02);
    const auto held = error_of(solution, exact, samples, std::numeric_limits<double>::infinity());
    const auto looked_at =
        error_of(solution, exact, samples, render::RenderOptions{}.scattering_tolerance);
    const auto closely = error_of(solution, exact, samples, 1e-5);
    INFO("held " << held.rmse << ", looked at " << looked_at.rmse << ", closely " << closely.rmse);
    CHECK(held.rmse > 0.05);
    if (samples == 1) {
        // Leaves that ask for nothing may leave 0.002 each, and a ray meets few; the reference's
        // steps of 2 cm leave 0.1 % where the cone ends.
        CHECK(looked_at.rmse < 0.005);
        CHECK(closely.rmse < 0.003);
    } else {
        // Two rays tell for eight, in pixels as large as the zones: a fourteenth and a sixth found.
        CHECK(looked_at.rmse < 0.25 * held.rmse);
    }
}
