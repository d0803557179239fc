// A sheet of light through a slit: which leaves does the mesh get, and for what?
//
//   Run:       build/release/bin/07_where_the_mesh_goes [folder]     writes level_*.png there
//   Shows:     error indicators by name, one of one's own, zones in colours on a plane
//   Builds on: 04_light_shaft
#include <cstdio>
#include <filesystem>
#include <memory>

#include "mesh/shapes.h"
#include "radiosity/adaptive.h"
#include "radiosity/indicators.h"
#include "radiosity/scene_builder.h"
#include "render/image_files.h"
#include "render/mesh_pictures.h"

using namespace tyndall;

int main(int argc, char** argv) {
    const std::filesystem::path folder = argc > 1 ? argv[1] : ".";

    // Light of a panel passes a slit in a wall that has no thickness.
    radiosity::Scene scene;
    add_surface(scene, "room", mesh::room({0, 0, 0}, {3, 2, 2}), {.reflectance = {0.3}});
    const std::vector<mesh::Opening> slit{{"slit", {0.9, 0.5}, {0.2, 1.0}}};  // [m]
    add_surface(scene, "screen", mesh::rectangle({1, 0, 0}, {0, 2, 0}, {0, 0, 2}, slit),
                {.reflectance = {0.3}});
    add_surface(scene, "lamp", mesh::rectangle({0, 0.8, 0.8}, {0, 0.4, 0}, {0, 0, 0.4}),
                {.reflectance = {0.0}, .power = {50.0}});                    // [W]
    scene.media = {{.name = "haze", .extinction = {0.3}, .albedo = {0.9}}};  // [1/m], [-]
    const auto enclosure =
        std::make_shared<const radiosity::Enclosure>(radiosity::make_enclosure(scene));

    // An indicator is an error [W/m^2/sr] of a leaf. This one asks for zones of at most 20 cm in
    // the second half of the room, whatever the light does there: a mesh made for the place.
    const auto beyond_the_screen = [](const radiosity::JudgedElement& element) {
        const auto* zone = std::get_if<mesh::ZoneId>(&element.node);
        if (!zone || element.forest.centroid(*zone).x < 1.0) return 0.0;
        return element.forest[*zone].longest_edge > 0.4 ? 1.0 : 0.0;
    };

    struct Trial {
        const char* name;
        std::vector<std::string> indicators;
        bool own;
    };
    const Trial trials[]{{"default", radiosity::SolveOptions{}.indicators, false},
                         {"own", {}, true}};
    for (const Trial& trial : trials) {
        radiosity::SolveOptions options{
            .error = 0.1, .max_elements = 8000, .rays = 16, .gather_rays = 16};
        options.indicators = trial.indicators;
        if (trial.own)
            options.indicator = std::make_shared<const radiosity::Indicator>(beyond_the_screen);
        const auto solution = radiosity::solve_adaptively(enclosure, options);
        std::printf("%-8s %6zu patches %6zu zones, estimated error %.3f\n", trial.name,
                    solution.report.patches, solution.report.zones,
                    solution.report.estimated_error);
        const auto slice = render::field_slice(solution, {{1.5, 1.0, 1.0}, {0, 0, 1}},
                                               {.field = "level", .low = {}, .high = {}});
        render::write_image(folder / (std::string("level_") + trial.name + ".png"), slice.image);
    }
}
