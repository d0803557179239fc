// Followed paths against what others computed: probes of the shaft box, and the window-shafts
// picture of an independent path tracer.
#include <numbers>

#include "cli/scene_file.h"
#include "radiosity/direct_light.h"
#include "render/image_files.h"
#include "render/light_paths.h"
#include "render/path_traced.h"
#include "support/catch.h"
#include "support/reference.h"

using namespace tyndall;

TEST_CASE("Followed paths: the shaft box's J and floor irradiance of all orders", "[probe]") {
    const auto file = test::reference("4g_shaft_total");
    const auto scene = cli::read_scene_file(TYNDALL_SOURCE_DIR "/tests/scenes/shaft_box.toml");
    const auto e = radiosity::make_enclosure(scene.scene);
    const render::LightPaths paths(e);
    const radiosity::DirectLight light(e);
    render::Seen seen;
    for (const auto& c : file["cases"]) {
        const std::string name = c["name"];
        const auto& p = c["geometry"]["point"];
        const bool floor = name.find("_E_") != std::string::npos;
        const mesh::Point x(p[0], p[1], floor ? 1e-5 : double(p[2]));
        const auto tet = mesh::locate(e.mesh, x);
        double direct = 0.0;
        if (floor)
            light.at_patch(x, {0, 0, 1}, tet, {&direct, 1});
        else
            light.at_zone(x, tet, {&direct, 1});
        // Light that comes straight from the lamp is known; the rest is a mean over directions.
        double sum = 0.0, square = 0.0;
        constexpr std::size_t count = 60000;
        for (std::size_t k = 0; k < count; ++k) {
            render::RandomNumbers random(3, k);
            const double u = random(), v = random();
            const auto d = floor ? radiosity::cosine_direction({0, 0, 1}, u, v)
                                 : radiosity::uniform_direction(u, v);
            seen.clear(1);
            paths.sample({x, d}, random, seen);
            double rest = 0.0;
            for (std::size_t part = render::emission + 1; part < render::part_count; ++part)
                rest += seen.radiance[part];
            sum += rest;
            square += rest * rest;
        }
        const double mean = sum / count;
        const double error = std::sqrt((square / count - mean * mean) / count);
        const double albedo = floor ? 1.0 : 0.8;
        const double value = albedo * (direct + mean), reference = c["value"];
        const double both = std::hypot(albedo * error, double(c["abs_uncertainty"]));
        INFO(name << ": " << value << " +- " << both << ", reference " << reference);
        // Of both, four standard errors: the reference's file says that much of its own.
        CHECK(std::abs(value - reference) < 4.0 * both);
        CHECK(error < 0.02 * mean);
    }
}

TEST_CASE("Followed paths: window shafts, by the noise of both pictures", "[picture]") {
    const auto file =
        cli::read_scene_file(TYNDALL_SOURCE_DIR "/examples/scenes/window_shafts.toml");
    const auto reference =
        render::read_image(TYNDALL_SOURCE_DIR "/tests/reference/window_shafts_80x60.pfm");
    auto camera = file.cameras.front();
    camera.width = reference.width;  // a pixel is a block of 4 × 4 of the whole picture
    camera.height = reference.height;
    const auto image =
        render::path_traced(radiosity::make_enclosure(file.scene), camera, {.samples = 400});
    const auto& ours = image.find("beauty")->values;
    const auto& error = image.find("error")->values;
    const auto& theirs = reference.layers[0].values;
    double mean = 0.0, difference = 0.0, variance = 0.0;
    for (std::size_t k = 0; k < ours.size(); ++k) {
        mean += theirs[k] / double(ours.size());
        difference += (ours[k] - theirs[k]) / double(ours.size());
        variance += std::pow(error[k] / double(ours.size()), 2);
    }
    // The reference's own noise is 0.3 % of its mean in such blocks.
    const double of_reference = 0.003 * mean;
    double square = 0.0;
    for (std::size_t k = 0; k < ours.size(); ++k)
        square +=
            std::pow(ours[k] - theirs[k], 2) / (std::pow(error[k], 2) + std::pow(of_reference, 2));
    // What 4800 pixels of Gaussian noise make of it is 1 ± 0.01; rare paths that a pixel has none
    // of, and so knows nothing of, add to it: 0.3 with 96 samples, 0.07 with 400.
    CHECK(std::sqrt(square / double(ours.size())) == Approx(1.0).margin(0.2));
    // No bias: 4.5 standard errors of the mean; the reference agrees with another renderer to
    // 0.02 %.
    CHECK(std::abs(difference) < 4.5 * std::sqrt(variance) + 2e-4 * mean);
    CHECK(std::sqrt(variance) < 0.005 * mean);
}
