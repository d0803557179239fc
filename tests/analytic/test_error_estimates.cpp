// Estimated errors against true ones: of pictures against a path tracer and finer runs, of
// solutions against finer runs.
#include <cmath>
#include <limits>

#include "cli/scene_file.h"
#include "radiosity/adaptive.h"
#include "render/compare.h"
#include "render/image_files.h"
#include "render/line_of_sight.h"
#include "support/catch.h"
#include "support/solution_difference.h"

using namespace tyndall;

namespace {

struct EstimatedScene {
    std::shared_ptr<const radiosity::Enclosure> enclosure;
    cli::SceneFile file;

    explicit EstimatedScene(const std::string& path)
        : file(cli::read_scene_file(std::string(TYNDALL_SOURCE_DIR "/") + path)) {
        enclosure =
            std::make_shared<const radiosity::Enclosure>(radiosity::make_enclosure(file.scene));
    }
    radiosity::Solution solve(const radiosity::SolveOptions& options) const {
        std::optional<radiosity::View> view;
        if (!file.cameras.empty()) view = file.cameras.front().view();
        return radiosity::solve_adaptively(enclosure, options, view);
    }
    render::Image picture(const radiosity::Solution& solution, std::size_t width,
                          std::size_t height) const {
        auto camera = file.cameras.front();
        camera.width = width;
        camera.height = height;
        auto options = file.render;
        options.samples = 64;  // edges of such large pixels are to be no error
        // Estimated is what elements hold, whatever a picture puts right.
        options.scattering_tolerance = render::as_elements_hold;
        return render::line_of_sight(solution, camera, options);
    }
};

// What docs/validation.md promises.
void check_ratio(double estimated, double measured) {
    INFO("estimated " << estimated << ", measured " << measured);
    CHECK(estimated >= 0.5 * measured);
    CHECK(estimated <= 2.0 * measured);
}

}  // namespace

TEST_CASE("Window shafts: the estimated error is that against a path tracer", "[estimate]") {
    const EstimatedScene scene("examples/scenes/window_shafts.toml");
    // Its noise is 0.3 % a pixel: a fifth of what is measured here.
    const auto exact =
        render::read_image(TYNDALL_SOURCE_DIR "/tests/reference/window_shafts_80x60.pfm");
    for (const auto refinement : {radiosity::Refinement::aligned, radiosity::Refinement::uniform}) {
        auto options = scene.file.solve;
        options.refinement = refinement;
        options.error = 0.05;
        options.rays = options.gather_rays = 64;
        const auto solution = scene.solve(options);
        const auto image = scene.picture(solution, 80, 60);
        REQUIRE(solution.report.picture_error);
        check_ratio(solution.report.picture_error->total(),
                    render::compare(80, 60, image.layers[0], exact.layers[0]).rmse);
    }
}

TEST_CASE("Shaft box: the solution's estimated error is that against a finer run",
          "[estimate][long]") {
    const EstimatedScene scene("tests/scenes/shaft_box.toml");
    auto options = scene.file.solve;
    options.error = 0.1;
    options.rays = options.gather_rays = 32;
    const auto solution = scene.solve(options);
    CHECK(!solution.report.picture_error);
    options.error = 0.04;
    options.rays = options.gather_rays = 128;
    options.seed = 7;
    check_ratio(solution.report.solution_error.total(),
                test::relative_difference(solution, scene.solve(options)));
}
