// Red, green and blue are three bands; any number will do.
//
//   Run:       build/release/bin/11_coloured_fog [folder]     writes coloured_fog.png there
//   Shows:     spectra: a value a band, or one for all; bands share every ray; what a band costs
//   Builds on: 04_light_shaft
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "mesh/shapes.h"
#include "radiosity/adaptive.h"
#include "radiosity/scene_builder.h"
#include "render/image_files.h"
#include "render/line_of_sight.h"

using namespace tyndall;

namespace {

// The first `bands` values of what is given for three.
radiosity::Spectrum of(std::size_t bands, double r, double g, double b) {
    return bands == 1 ? radiosity::Spectrum{(r + g + b) / 3.0} : radiosity::Spectrum{r, g, b};
}

}  // namespace

int main(int argc, char** argv) {
    const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
    double grey = 0.0;
    for (const std::size_t bands : {1, 3}) {
        radiosity::Scene scene;
        scene.bands = bands;
        const mesh::FaceOpening window{"x0", {"window", {0.9, 0.9}, {1.0, 1.0}}};  // [m]
        add_surface(scene, "room", mesh::room({0, 0, 0}, {4, 3, 2.5}, {window}),
                    {.reflectance = of(bands, 0.6, 0.5, 0.35)},
                    radiosity::Material{.reflectance = {0.0}});  // one value: the same in all bands
        // Fog that takes blue away and scatters it more, as thin smoke does.
        scene.media = {{.name = "smoke",
                        .extinction = of(bands, 0.10, 0.18, 0.30),  // [1/m]
                        .albedo = of(bands, 0.95, 0.93, 0.90),
                        .at = mesh::Point{2.0, 1.5, 1.2}}};
        scene.lights = {
            {.name = "sun",
             .source = radiosity::Sun{.direction = {0.8, 0.1, -0.5},
                                      .irradiance = of(bands, 900, 800, 650),  // [W/m^2]
                                      .angle = 0.0093}}};
        const auto start = std::chrono::steady_clock::now();
        render::Camera camera;
        camera.eye = {3.7, 0.2, 1.2};
        camera.target = {1.0, 2.0, 0.9};
        camera.fov_x = 1.2;  // [rad]
        camera.width = 160;
        camera.height = 120;
        const auto solution = radiosity::solve_adaptively(
            std::make_shared<const radiosity::Enclosure>(radiosity::make_enclosure(scene)),
            {.error = 0.2, .max_elements = 8000, .rays = 64, .gather_rays = 32}, camera.view());
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
        std::printf("%zu band%s: %zu patches, %zu zones, %.2f s%s\n", bands, bands == 1 ? " " : "s",
                    solution.report.patches, solution.report.zones, took.count(),
                    bands == 1 ? ""
                               : (", " + std::to_string(took.count() / grey).substr(0, 4) +
                                  " times as long")
                                     .c_str());
        grey = took.count();
        if (bands == 3)
            render::write_image(folder / "coloured_fog.png",
                                render::line_of_sight(solution, camera, {.samples = 4}));
    }
}
