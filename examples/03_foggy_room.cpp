// A lamp in a room full of fog: where do its watts go, and how bright is the fog?
//
//   Run:       build/release/bin/03_foggy_room
//   Shows:     the adaptive solve, its report (balance of energy, net power by name), values at
//   points Builds on: 02_furnace
#include <cstdio>

#include "mesh/shapes.h"
#include "radiosity/adaptive.h"
#include "radiosity/probe.h"
#include "radiosity/scene_builder.h"

using namespace tyndall;

int main() {
    // A panel lies in the ceiling and looks down. Where surfaces coincide the later one counts.
    radiosity::Scene scene;
    add_surface(scene, "room", mesh::room({0, 0, 0}, {4, 3, 3}), {.reflectance = {0.7}});
    add_surface(scene, "panel", mesh::rectangle({1.5, 1, 3}, {0, 1, 0}, {1, 0, 0}),
                {.reflectance = {0.0}, .power = {100.0}});                  // [W]
    scene.media = {{.name = "fog", .extinction = {0.5}, .albedo = {0.9}}};  // [1/m], [-]

    // The loop: a coarse solution, then the mesh refined where direct and indirect light bend,
    // until the estimated error meets the goal. Ten percent is quick; the default is one.
    const auto solution = radiosity::solve_adaptively(
        std::make_shared<const radiosity::Enclosure>(radiosity::make_enclosure(scene)),
        {.error = 0.1, .max_elements = 4000, .rays = 128, .gather_rays = 64});

    const auto& report = solution.report;
    std::printf("%zu patches, %zu zones, estimated error %.3f\n\n", report.patches, report.zones,
                report.estimated_error);

    // Net power is what goes out less what comes in: of the panel its 100 W less what the room
    // sends back, of walls and fog what they absorb, with a minus. The sum is zero if no light is
    // lost or made up.
    double sum = 0.0;
    for (const auto& [name, power] : report.net_power) {
        std::printf("%-16s %8.2f W\n", name.c_str(), power[0]);
        sum += power[0];
    }
    std::printf("%-16s %8.2f W   (energy balance %.0e)\n\n", "sum", sum, report.energy_balance);

    // The source radiance J: what the fog sends out, per metre and optical depth one, in every
    // direction. A probe computes it right at a point, finer than the zones are.
    const radiosity::Probe probe(solution, {.rays = 256});
    std::printf("below the panel   J direct   J  [W/m^2/sr]\n");
    for (double z = 2.75; z > 0.0; z -= 0.5) {
        const auto values = probe.in_space({2.0, 1.5, z});
        std::printf("z = %.2f m        %8.3f %8.3f\n", z, values.source_direct[0],
                    values.source[0]);
    }
}
