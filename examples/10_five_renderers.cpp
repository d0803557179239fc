// One solution, every renderer: what each sees of it, and how far it is from the others.
//
//   Run:       build/release/bin/10_five_renderers [folder]     writes renderer_*.png there
//   Shows:     renderers by name; where they differ; comparing pictures
//   Builds on: 09_keep_a_solution
#include <cstdio>
#include <filesystem>
#include <memory>

#include "mesh/shapes.h"
#include "radiosity/adaptive.h"
#include "radiosity/scene_builder.h"
#include "render/compare.h"
#include "render/image_files.h"
#include "render/renderers.h"

using namespace tyndall;

int main(int argc, char** argv) {
    const std::filesystem::path folder = argc > 1 ? argv[1] : ".";

    // A room in fog, its lamp behind a shelf.
    radiosity::Scene scene;
    add_surface(scene, "room", mesh::room({0, 0, 0}, {2, 2, 2}), {.reflectance = {0.5}});
    add_surface(scene, "lamp", mesh::rectangle({0.7, 0.7, 2}, {0, 0.6, 0}, {0.6, 0, 0}),
                {.reflectance = {0.0}, .power = {50.0}});  // [W]
    add_surface(scene, "shelf", mesh::rectangle({0, 0, 1.2}, {1, 0, 0}, {0, 2, 0}),
                {.reflectance = {0.5}});
    scene.media = {{.name = "fog", .extinction = {0.4}, .albedo = {0.9}}};  // [1/m], [-]
    render::Camera camera;
    camera.eye = {1.9, 0.1, 1.0};
    camera.target = {0.5, 1.6, 1.0};
    camera.fov_x = 1.2;  // [rad]
    camera.width = 48;
    camera.height = 36;

    const auto solution = radiosity::solve_adaptively(
        std::make_shared<const radiosity::Enclosure>(radiosity::make_enclosure(scene)),
        {.error = 0.05, .max_elements = 8000, .rays = 64, .gather_rays = 32}, camera.view());

    // The first is the default. The last two draw lots: path_traced uses nothing of the solution
    // but its scene, and is noisy; two_pass takes the light of later bounces from the solution.
    const auto reference =
        render::renderers().front().render(solution, camera, {.samples = 16}, {});
    std::printf("against %s        16 x 16 blocks   single pixels\n",
                render::renderers().front().name.data());
    for (const render::NamedRenderer& renderer : render::renderers()) {
        const std::string name(renderer.name);
        const auto picture = renderer.render(solution, camera, {.samples = 16}, {});
        const auto error = render::compare(camera.width, camera.height, *picture.find("beauty"),
                                           *reference.find("beauty"));
        std::printf("%-24s %12.2f %% %13.2f %%\n", name.c_str(), 100.0 * error.block16,
                    100.0 * error.rmse);
        render::write_image(folder / ("renderer_" + name + ".png"), picture);
    }
}
