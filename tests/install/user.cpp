#include "mesh/shapes.h"
#include "radiosity/adaptive.h"
#include "radiosity/scene_builder.h"
#include "render/image_files.h"
#include "render/line_of_sight.h"

using namespace tyndall;

int main() {
    // What there is: surfaces and what they are made of, media. Lengths in metres, light in watts.
    radiosity::Scene scene;
    add_surface(scene, "room", mesh::room({0, 0, 0}, {4, 3, 3}), {.reflectance = {0.7}});
    add_surface(scene, "panel", mesh::rectangle({1.5, 1, 3}, {0, 1, 0}, {1, 0, 0}),
                {.reflectance = {0.0}, .emission = {500.0}});
    scene.media = {{.name = "smoke", .extinction = {0.3}, .albedo = {0.9}}};

    // Who looks, and how much the picture should be worth.
    render::Camera camera;
    camera.eye = {3.6, 0.3, 1.6};
    camera.target = {1, 2, 1.2};
    camera.fov_y = 1.0;
    camera.width = 160;
    camera.height = 120;
    scene.viewpoints = {camera.eye};

    // Mesh, solve, render. Coarse, to be quick: without options the goal is 1 %.
    const radiosity::SolveOptions options{
        .error = 0.1, .element_size = 1.0, .max_elements = 4000, .rays = 64, .gather_rays = 64};
    const auto enclosure =
        std::make_shared<const radiosity::Enclosure>(radiosity::make_enclosure(scene));
    const auto solution = radiosity::solve_adaptively(enclosure, options, camera.view());
    render::write_image("smoky_room.png", render::line_of_sight(solution, camera));
}
