// A furnace: a room all at one temperature, walls and haze. In it nothing can be told apart: every
// element has the same radiance, whatever it is made of.
//
//   Run:       build/release/bin/02_furnace
//   Shows:     the one equation of patches and zones, and the test that no solver can talk itself
//   out of Builds on: 01_two_squares
#include <algorithm>
#include <cstdio>

#include "mesh/shapes.h"
#include "radiosity/adaptive.h"
#include "radiosity/scene_builder.h"

using namespace tyndall;

// x_i = e_i + a_i H_i: what an element sends out is what it emits, and of what comes in, H, the
// share a: a wall's reflectance, the haze's albedo. At one temperature e = 1 - a (Kirchhoff), hence
// x = 1.
void furnace(double reflectance, double extinction, double albedo, double haze_emission) {
    radiosity::Scene scene;
    add_surface(scene, "room", mesh::room({0, 0, 0}, {4, 3, 3}),
                {.reflectance = {reflectance}, .emission = {1.0 - reflectance}});  // [W/m^2/sr]
    scene.media = {{.name = "haze",
                    .extinction = {extinction},  // [1/m]
                    .albedo = {albedo},
                    .emission = {haze_emission}}};  // of a black body as hot [W/m^2/sr]

    // No refinement: a furnace is exact on any mesh. All light goes through the exchange areas.
    const auto solution = radiosity::solve_adaptively(
        std::make_shared<const radiosity::Enclosure>(radiosity::make_enclosure(scene)),
        {.refinement = radiosity::Refinement::none,
         .direct_light = radiosity::DirectLightMode::rows,
         .rays = 64,
         .solver_tolerance = 1e-9});
    const auto& x = solution.coarse.radiance;
    const auto [least, most] = std::minmax_element(x.begin(), x.end());
    std::printf("%11.2f  %6.2f /m  %6.2f  %13.2f  %.6f to %.6f\n", reflectance, extinction, albedo,
                haze_emission, *least, *most);
}

int main() {
    std::printf("reflectance  extinction  albedo  haze emission  radiance of all elements\n");
    furnace(0.3, 0.5, 0.2, 1.0);
    furnace(0.9, 0.5, 0.2, 1.0);  // whiter walls emit less, and reflect more: still 1
    furnace(0.9, 5.0, 0.8, 1.0);  // thicker haze
    furnace(0.3, 0.5, 0.2, 0.5);  // cooler haze: no furnace any more. Change a number, and watch
}
