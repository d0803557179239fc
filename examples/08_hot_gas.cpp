// Gas between a hot and a cold plate finds its temperature.
//
//   Run:       build/release/bin/08_hot_gas
//   Shows:     radiative equilibrium, temperatures in and out, net flux by name; Heaslet & Warming
//   Builds on: 03_foggy_room
#include <cmath>
#include <cstdio>
#include <memory>

#include "mesh/shapes.h"
#include "radiosity/adaptive.h"
#include "radiosity/scene_builder.h"
#include "radiosity/temperatures.h"

using namespace tyndall;
using namespace tyndall::radiosity;

int main() {
    // Two black plates a metre apart, six metres wide, and gas between them that is a mean free
    // path across. No heat is brought to the gas or taken from it: it sends out all that it takes.
    const double wide = 6.0;                  // [m]
    const double hot = 1000.0, cold = 300.0;  // [K]
    Scene scene;
    scene.thermal = true;
    const double sigma = 5.670374419e-8;  // [W/m^2/K^4]
    const auto black = [&](double t) {    // its radiance [W/m^2/sr]
        return Spectrum{sigma * std::pow(t, 4) / M_PI};
    };
    const Material floor{.reflectance = {0.0}, .emission = black(hot)};
    const Material ceiling{.reflectance = {0.0}, .emission = black(cold)};
    const Material rim{.reflectance = {0.0},
                       .flux = {0.0}};  // adiabatic: what arrives is sent back
    for (const mesh::Face& face : mesh::room({0, 0, 0}, {wide, wide, 1}))
        add_surface(scene, "box", {face},
                    face.name == "floor"     ? floor
                    : face.name == "ceiling" ? ceiling
                                             : rim);
    scene.media = {{.name = "gas", .extinction = {1.0}, .albedo = {0.0}}};  // [1/m], [-]
    scene.media[0].heat = {0.0};                                            // [W/m^3]

    const Solution solution =
        solve_adaptively(std::make_shared<const Enclosure>(make_enclosure(scene)),
                         {.start = Start::uniform,
                          .refinement = Refinement::uniform,
                          .element_size = 1.2,
                          .max_elements = 4000,
                          .rays = 48,
                          .gather_rays = 16});

    // The mean of T^4 of the gas in the middle of the plates, in layers, over that of the plates.
    const double span4 = std::pow(hot, 4) - std::pow(cold, 4);
    double sum[4]{}, volume[4]{};
    const auto& forest = solution.forest;
    for (std::uint32_t z = 0; z < forest.zone_count(); ++z) {
        const mesh::ZoneId zone(z);
        if (!forest.is_leaf(zone)) continue;
        const auto centre = forest.centroid(zone);
        const double t = temperature_of(solution, zone);
        if (centre.z < 0.0 || centre.z > 1.0 || std::isnan(t)) continue;
        if (std::abs(centre.x - 0.5 * wide) > 1.5 || std::abs(centre.y - 0.5 * wide) > 1.5)
            continue;
        const int layer = std::min(3, int(4.0 * centre.z));
        sum[layer] += forest.volume(zone) * (std::pow(t, 4) - std::pow(cold, 4)) / span4;
        volume[layer] += forest.volume(zone);
    }
    std::printf("height          (T^4 - Tc^4) / (Th^4 - Tc^4)      T\n");
    for (int layer = 0; layer < 4; ++layer) {
        const double share = sum[layer] / volume[layer];
        std::printf("%.2f to %.2f m              %.3f               %5.0f K\n", 0.25 * layer,
                    0.25 * (layer + 1), share, std::pow(share * span4 + std::pow(cold, 4), 0.25));
    }
    // For plates without an end the flux is 0.5532 of that without gas (Heaslet & Warming 1965); a
    // rim three metres away, which sends half of what it gets back, takes some of it.
    std::printf("\n");
    for (const auto& [name, power] : solution.report.net_power)
        if (name == "box.floor+")
            std::printf("%s: %.4f of what it would send across without gas\n", name.c_str(),
                        power[0] / (wide * wide) / (sigma * span4));
}
