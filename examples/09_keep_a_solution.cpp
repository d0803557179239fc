// A solution is a file: written once, it is looked at again without solving.
//
//   Run:       build/release/bin/09_keep_a_solution [folder]   writes kept.vtkhdf, kept_*.png there
//   Shows:     solution files, two cameras, values at points; the same bits after reading
//   Builds on: 04_light_shaft
#include <cstdio>
#include <filesystem>
#include <memory>

#include "mesh/shapes.h"
#include "radiosity/adaptive.h"
#include "radiosity/probe.h"
#include "radiosity/scene_builder.h"
#include "radiosity/solution_file.h"
#include "render/image_files.h"
#include "render/line_of_sight.h"

using namespace tyndall;

namespace {

radiosity::Solution solved_room() {
    radiosity::Scene scene;
    add_surface(scene, "room", mesh::room({0, 0, 0}, {4, 3, 2.5}), {.reflectance = {0.6}});
    add_surface(scene, "table", mesh::box({1.5, 1.0, 0.0}, {2.5, 2.0, 0.8}),
                {.reflectance = {0.4}});
    add_surface(scene, "lamp", mesh::rectangle({1.8, 1.3, 2.5}, {0, 0.4, 0}, {0.4, 0, 0}),
                {.reflectance = {0.0}, .power = {60.0}});                    // [W]
    scene.media = {{.name = "haze", .extinction = {0.2}, .albedo = {0.9}}};  // [1/m], [-]
    return radiosity::solve_adaptively(
        std::make_shared<const radiosity::Enclosure>(radiosity::make_enclosure(scene)),
        {.error = 0.1, .max_elements = 4000, .rays = 64, .gather_rays = 32});
}

}  // namespace

int main(int argc, char** argv) {
    const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
    const auto file = folder / "kept.vtkhdf";

    double at_once = 0.0;
    {
        const radiosity::Solution solution = solved_room();
        radiosity::write_solution(file, solution);
        at_once = radiosity::Probe(solution, {.rays = 64}).in_space({2.0, 1.5, 1.5}).source[0];
    }

    // Another program, another day. ParaView opens the file as well.
    const auto [solution, attachments] = radiosity::read_solution(file);
    const double later =
        radiosity::Probe(solution, {.rays = 64}).in_space({2.0, 1.5, 1.5}).source[0];
    std::printf("J over the table: %.9f W/m^2/sr when solved, %.9f from the file: %s\n", at_once,
                later, at_once == later ? "the same bits" : "NOT the same");

    render::Camera camera;
    camera.fov_x = 1.2;  // [rad]
    camera.width = 96;
    camera.height = 72;
    camera.target = {2.0, 1.5, 0.8};
    const mesh::Point eyes[]{{0.3, 0.3, 1.6}, {3.7, 2.7, 0.6}};
    for (int k = 0; k < 2; ++k) {
        camera.eye = eyes[k];
        const auto picture = render::line_of_sight(solution, camera, {.samples = 4});
        render::write_image(folder / ("kept_" + std::to_string(k + 1) + ".png"), picture);
    }
    return at_once == later ? 0 : 1;
}
