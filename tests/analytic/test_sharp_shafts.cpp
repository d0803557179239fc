// Sharp light shafts: pictures from meshes that are cut along shadows' edges and from meshes that
// are not, against small steps along every ray with exact visibility.
#include <limits>

#include "cli/scene_file.h"
#include "radiosity/adaptive.h"
#include "render/compare.h"
#include "render/line_of_sight.h"
#include "support/catch.h"
#include "support/marched_picture.h"

using namespace tyndall;

namespace {

struct ShaftCase {
    std::shared_ptr<const radiosity::Enclosure> enclosure;
    render::Camera camera;
    render::RenderOptions render;
    radiosity::SolveOptions solve;
    render::Layer exact;
};

ShaftCase small(const std::string& scene) {
    const auto file = cli::read_scene_file(TYNDALL_SOURCE_DIR + scene);
    ShaftCase c;
    c.enclosure =
        std::make_shared<const radiosity::Enclosure>(radiosity::make_enclosure(file.scene));
    c.camera = file.cameras.front();
    c.camera.width = 96;
    c.camera.height = 72;
    c.render = file.render;
    c.render.samples = 4;
    c.render.contrast = 0.0;  // the rays of the exact picture
    // The mesh is to hold the shafts: no ray looks at them anew.
    c.render.scattering_tolerance = render::as_elements_hold;
    c.solve.rays = 4;  // nothing is asked of indirect light
    c.solve.gather_rays = 1;
    c.exact = test::marched_picture(*c.enclosure, c.camera, c.render.samples, 0.003);
    return c;
}

struct Outcome {
    std::size_t elements = 0;
    render::PictureError error;
};

Outcome outcome(const ShaftCase& c, radiosity::Refinement refinement, double goal,
                std::size_t max_elements) {
    auto options = c.solve;
    options.refinement = refinement;
    options.error = goal;
    options.max_elements = max_elements;
    const auto solution = radiosity::solve_adaptively(c.enclosure, options, c.camera.view());
    const auto image = render::line_of_sight(solution, c.camera, c.render);
    // Those that direct light asks for: too few rays on purpose make indirect light ask for more.
    std::size_t elements = 0;
    for (const auto& pass : solution.report.passes)
        if (pass.stage == "direct light") elements = pass.patches + pass.zones;
    return {elements, render::compare(image.width, image.height,
                                      render::select_layer(image, "direct_single"), c.exact)};
}

}  // namespace

// 0.3 % of the direct and single-scattered picture; the steps of the reference leave 0.05 %.
TEST_CASE("Sun without a diameter: aligned meshes need a thirtieth of the elements",
          "[picture][long]") {
    const ShaftCase c = small("/examples/scenes/sharp_sun.toml");
    const Outcome aligned = outcome(c, radiosity::Refinement::aligned, 0.005, 150000);
    CAPTURE(aligned.elements, aligned.error.rmse);
    CHECK(aligned.error.rmse < 0.003);
    CHECK(std::abs(aligned.error.bias) < 0.001);
    CHECK(aligned.elements < 12000);
    const Outcome plain = outcome(c, radiosity::Refinement::view, 0.001, 40 * aligned.elements);
    CAPTURE(plain.elements, plain.error.rmse);
    CHECK(plain.elements > 30 * aligned.elements);
    CHECK(plain.error.rmse > 0.003);
}

TEST_CASE("A lamp of 2 cm: both sides of its penumbrae are edges of elements", "[picture][long]") {
    const ShaftCase c = small("/tests/scenes/tiny_lamp.toml");
    const Outcome aligned = outcome(c, radiosity::Refinement::aligned, 0.01, 150000);
    CAPTURE(aligned.elements, aligned.error.rmse);
    CHECK(aligned.error.rmse < 0.003);
    CHECK(std::abs(aligned.error.bias) < 0.001);
    CHECK(aligned.elements < 18000);
    // As many elements elsewhere are five times as wrong at least.
    const Outcome plain = outcome(c, radiosity::Refinement::view, 0.001, aligned.elements);
    CAPTURE(plain.elements, plain.error.rmse);
    CHECK(plain.error.rmse > 5.0 * aligned.error.rmse);
}
