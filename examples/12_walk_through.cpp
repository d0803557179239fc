// A room to walk through: one HTML file, which needs no server and no network.
//
//   Run:       build/release/bin/12_walk_through [folder]     writes walk_through.html there
//   Shows:     the page from C++; cameras in it; what of it is exact
//   Builds on: 09_keep_a_solution
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>

#include "mesh/shapes.h"
#include "radiosity/adaptive.h"
#include "radiosity/scene_builder.h"
#include "view/view_page.h"

using namespace tyndall;

int main(int argc, char** argv) {
    const std::filesystem::path folder = argc > 1 ? argv[1] : ".";

    // Two rooms and a door between them; a spot shines through it.
    radiosity::Scene scene;
    add_surface(scene, "rooms", mesh::room({0, 0, 0}, {5, 3, 2.5}), {.reflectance = {0.5}});
    const std::vector<mesh::Opening> door{{"door", {1.1, 0.0}, {0.8, 2.0}}};  // [m]
    add_surface(scene, "wall", mesh::rectangle({2, 0, 0}, {0, 3, 0}, {0, 0, 2.5}, door),
                {.reflectance = {0.5}});
    scene.media = {{.name = "haze", .extinction = {0.15}, .albedo = {0.95}}};  // [1/m], [-]
    scene.lights = {{.name = "spot",
                     .source = radiosity::SpotLight{.position = {0.2, 1.5, 1.8},  // [m]
                                                    .direction = {1.0, 0.0, -0.2},
                                                    .intensity = {60.0},  // [W/sr]
                                                    .angle = 1.0}}};      // [rad]
    const auto solution = radiosity::solve_adaptively(
        std::make_shared<const radiosity::Enclosure>(radiosity::make_enclosure(scene)),
        {.error = 0.1, .max_elements = 15000, .rays = 32, .gather_rays = 32});

    // On the page: walk with WASD, look with the mouse, cut the room open, pick an element.
    render::Camera camera;
    camera.eye = {4.6, 0.4, 1.5};
    camera.target = {2.0, 1.5, 1.1};
    camera.fov_x = 1.2;  // [rad]
    view::PageOptions options;
    options.title = "Two rooms";
    options.cameras = {camera};
    const std::string page = view::view_page(solution, options);
    const auto file = folder / "walk_through.html";
    std::ofstream(file, std::ios::binary) << page;
    std::printf("%zu zones in %.1f MB: open %s in a browser\n", solution.report.zones,
                1e-6 * static_cast<double>(page.size()), file.c_str());
}
