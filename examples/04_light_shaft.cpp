// Sun through a window into a hazy room: a light shaft, as a picture.
//
//   Run:       build/release/bin/04_light_shaft [folder]     writes light_shaft.png and .exr there
//   Shows:     a window, the sun, a camera; a solve refined for what the camera sees; the picture
//   Builds on: 03_foggy_room
#include <cstdio>
#include <filesystem>

#include "mesh/shapes.h"
#include "radiosity/adaptive.h"
#include "radiosity/scene_builder.h"
#include "render/image_files.h"
#include "render/line_of_sight.h"

using namespace tyndall;

int main(int argc, char** argv) {
    const std::filesystem::path folder = argc > 1 ? argv[1] : ".";

    // A room with a window in the wall at x = 0, plaster inside, black outside.
    radiosity::Scene scene;
    const mesh::FaceOpening window{"x0", {"window", {1.2, 1.1}, {1.0, 1.2}}};  // corner, size [m]
    add_surface(scene, "room", mesh::room({0, 0, 0}, {5, 4, 3}, {window}), {.reflectance = {0.3}},
                radiosity::Material{.reflectance = {0.0}});
    scene.media = {{.name = "haze",
                    .extinction = {0.15},  // [1/m]
                    .albedo = {0.95},
                    .at = mesh::Point{2.5, 2.0, 1.5}}};         // in the room alone [m]
    const radiosity::Sun sun{.direction = {0.80, 0.10, -0.59},  // in which its light travels
                             .irradiance = {800.0},             // [W/m^2]
                             .angle = 0.0093};                  // half a degree [rad]
    scene.lights = {{.name = "sun", .source = sun}};
    scene.environment = {4.0};  // the sky [W/m^2/sr]

    render::Camera camera;
    camera.eye = {3.5, 0.25, 1.3};
    camera.target = {1.3, 2.6, 0.95};
    camera.fov_x = 1.2;  // [rad]
    camera.width = 320;
    camera.height = 240;
    scene.viewpoints = {camera.eye};

    // Mesh, solve for the camera, render, write. A goal of 0.01 makes a picture to keep.
    const auto enclosure =
        std::make_shared<const radiosity::Enclosure>(radiosity::make_enclosure(scene));
    const auto solution = radiosity::solve_adaptively(
        enclosure, {.error = 0.03, .max_elements = 80000, .rays = 64, .gather_rays = 64},
        camera.view());
    const auto picture = render::line_of_sight(solution, camera, {.samples = 4});
    render::write_image(folder / "light_shaft.png", picture);  // for eyes
    render::write_image(folder / "light_shaft.exr", picture);  // linear, in layers
    std::printf("%zu patches, %zu zones: %s\n", solution.report.patches, solution.report.zones,
                (folder / "light_shaft.png").c_str());
}
