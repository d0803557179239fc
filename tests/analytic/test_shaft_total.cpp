// Light-shaft box, all orders of scattering: probes of a whole solve against Monte Carlo.
#include <cmath>
#include <numbers>

#include "cli/scene_file.h"
#include "radiosity/adaptive.h"
#include "radiosity/probe.h"
#include "support/catch.h"
#include "support/reference.h"

using namespace tyndall;

TEST_CASE("Shaft box: J and floor irradiance of all orders against Monte Carlo", "[probe][long]") {
    const auto file = test::reference("4g_shaft_total");
    auto scene = cli::read_scene_file(TYNDALL_SOURCE_DIR "/tests/scenes/shaft_box.toml");
    // Probes compute direct light anew and gather the rest: a third of the scene's own goal will
    // do.
    scene.solve.error = 0.06;
    const auto solution = radiosity::solve_adaptively(
        std::make_shared<const radiosity::Enclosure>(radiosity::make_enclosure(scene.scene)),
        scene.solve);
    const radiosity::Probe probe(solution, {.rays = 8192});
    for (const auto& c : file["cases"]) {
        const std::string name = c["name"];
        const auto& p = c["geometry"]["point"];
        const mesh::Point x(p[0], p[1], p[2]);
        const double reference = c["value"], standard_error = c["abs_uncertainty"];
        const bool floor = name.find("_E_") != std::string::npos;
        const double value = floor ? probe.on_surface(x, {0, 0, 1}).irradiance[0] / std::numbers::pi
                                   : probe.in_space(x).source[0];
        INFO(name << ": " << value << ", reference " << reference);
        // The reference's estimator is heavy-tailed: four of its standard errors; or 1 % of the
        // value.
        CHECK(std::abs(value - reference) <= std::max(4.0 * standard_error, 0.01 * reference));
    }
}
