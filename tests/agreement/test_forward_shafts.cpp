// A beam through fog that scatters forwards, by the renderers that follow its direction.
#include "cli/scene_file.h"
#include "radiosity/adaptive.h"
#include "render/last_scatter.h"
#include "render/line_of_sight.h"
#include "render/path_traced.h"
#include "render/two_pass.h"
#include "support/catch.h"
#include "support/path_scenes.h"

using namespace tyndall;

namespace {

constexpr std::size_t edge = 16;  // of blocks, in pixels

// Means of whole blocks; `noise`: root mean square of their standard errors.
struct Blocks {
    std::vector<double> values;
    double mean = 0.0, noise = 0.0;
};

Blocks blocks(const render::Image& image, const std::string& layer = "beauty") {
    const auto& values = image.find(layer)->values;
    const auto* error = image.find("error");
    Blocks result;
    for (std::size_t y = 0; y + edge <= image.height; y += edge)
        for (std::size_t x = 0; x + edge <= image.width; x += edge) {
            double sum = 0.0, variance = 0.0;
            for (std::size_t k = 0; k < edge * edge; ++k) {
                const std::size_t at = (y + k / edge) * image.width + x + k % edge;
                sum += double(values[at]) / double(edge * edge);
                if (error) variance += std::pow(double(error->values[at]) / double(edge * edge), 2);
            }
            result.values.push_back(sum);
            result.mean += sum;
            result.noise += variance;
        }
    const double count = double(result.values.size());
    result.mean /= count;
    result.noise = std::sqrt(result.noise / count) / result.mean;
    return result;
}

double departure(const Blocks& a, const Blocks& reference) {
    double square = 0.0;
    for (std::size_t k = 0; k < a.values.size(); ++k)
        square += std::pow(a.values[k] - reference.values[k], 2);
    return std::sqrt(square / double(a.values.size())) / reference.mean;
}

}  // namespace

TEST_CASE("Forward shafts: window shafts with g = 0.7 by paths, last_scatter and two_pass",
          "[picture][long]") {
    auto file = cli::read_scene_file(TYNDALL_SOURCE_DIR "/examples/scenes/window_shafts.toml");
    file.scene.media.front().asymmetry = 0.7;
    auto camera = file.cameras.front();
    camera.width = 80;
    camera.height = 64;  // whole blocks
    const auto solution =
        radiosity::solve_adaptively(test::enclosed(file.scene), {.error = 0.1}, camera.view());
    const auto paths =
        blocks(render::path_traced(*solution.enclosure, camera, {.samples = 512, .seed = 7}));
    const auto last = blocks(render::last_scatter(solution, camera, {.samples = 16}));
    const auto two = blocks(render::two_pass(solution, camera, {.samples = 256}));
    const auto line = blocks(render::line_of_sight(solution, camera, {.samples = 4}));
    INFO("paths' noise " << paths.noise << ", two_pass's " << two.noise << ", last_scatter "
                         << departure(last, paths) << ", two_pass " << departure(two, paths)
                         << ", line_of_sight " << departure(line, paths));
    // 2 % is what is asked of these blocks; noise is known to a tenth of itself by 20 of them, and
    // what it adds to 2 % is small.
    CHECK(paths.noise < 0.01);
    CHECK(two.noise < 0.012);
    CHECK(departure(last, paths) < std::hypot(0.02, 1.2 * paths.noise));
    CHECK(departure(two, paths) < std::hypot(0.02, 1.2 * std::hypot(two.noise, paths.noise)));
    CHECK(std::abs(last.mean / paths.mean - 1.0) < 0.015);
    // The isotropic picture has the light, elsewhere.
    CHECK(departure(line, paths) > 0.2);
}
