// What a cube of gas exchanges with its walls, by every method that the literature has for it.
//
//   Run:       build/release/bin/06_exchange_areas
//   Shows:     methods by name, under one signature; whole sides and media; what each costs, and
//              how far its rows are from closing
//   Builds on: 01_two_squares
#include <chrono>
#include <cstdio>

#include "mesh/input_error.h"
#include "mesh/shapes.h"
#include "radiosity/exchange_table.h"
#include "radiosity/scene_builder.h"

using namespace tyndall;
using namespace tyndall::radiosity;

int main() {
    // A metre of gas, one mean free path across, between black walls.
    Scene scene;
    add_surface(scene, "box", mesh::room({0, 0, 0}, {1, 1, 1}), {.reflectance = {0.0}});
    scene.media = {{.name = "gas", .extinction = {1.0}, .albedo = {0.0}}};  // [1/m], [-]
    const Enclosure enclosure = make_enclosure(scene);

    // An exchange area [m^2] is what of a radiance of 1 in one element arrives in another, over pi.
    // All that leaves the gas, 4 kappa V = 4 m^2, goes to six equal walls and back into the gas.
    std::printf("method                 gas to floor   gas to gas   rest of a row        s\n");
    for (const NamedExchangeMethod& method : exchange_methods()) {
        ExchangeOptions options;
        options.settings.tolerance = 1e-3;  // of methods that can keep one
        options.settings.resolution = 32;   // of cubes, pixels along an edge
        const auto start = std::chrono::steady_clock::now();
        try {
            const ExchangeTable table =
                exchange_table(enclosure, method, options, {"gas"}, {"gas", "box.floor+"});
            double to_gas = 0.0, to_floor = 0.0;
            for (const auto& entry : table.entries)
                (entry.to == "gas" ? to_gas : to_floor) = entry.exchange_area[0];
            const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
            std::printf("%-22.*s %11.5f %12.5f %15.1e %8.2f\n", int(method.name.size()),
                        method.name.data(), to_floor, to_gas, 4.0 - 6.0 * to_floor - to_gas,
                        took.count());
        } catch (const mesh::InputError& error) {
            // Some methods know surfaces alone, and say so.
            std::printf("%-22.*s knows no volumes\n", int(method.name.size()), method.name.data());
        }
    }
}
