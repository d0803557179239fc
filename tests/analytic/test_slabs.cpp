// Slabs in radiative equilibrium between black walls, up to an optical thickness of 20: a box at
// least three times as wide as thick, whose sides are white. Far from the sides it is the infinite
// slab.
#include <algorithm>
#include <numbers>

#include "radiosity/adaptive.h"
#include "radiosity/probe.h"
#include "support/catch.h"
#include "support/reference.h"
#include "support/rooms.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

// Of a slab 1 m thick: what the sides change is felt for a few mean free paths [m].
double width_of(double optical_thickness) {
    return std::max(3.0, 9.0 / optical_thickness);
}

std::shared_ptr<const Enclosure> slab(double optical_thickness) {
    const double width = width_of(optical_thickness);
    Scene scene;
    scene.materials = {test::material(1.0), test::material(0.0, 1.0), test::material(0.0)};
    test::add_surfaces(scene, "box", mesh::room({0, 0, 0}, {width, width, 1}), 0);
    scene.surfaces[test::surface_named(scene, "box.floor")].material = 1;
    scene.surfaces[test::surface_named(scene, "box.ceiling")].material = 2;
    scene.media = {test::medium(optical_thickness, 1.0)};
    return std::make_shared<const Enclosure>(make_enclosure(scene));
}

// q/(π (I_1 − I_2)) for black walls. Above the file's thicknesses: the thick limit, in which the
// walls' distance grows by twice Hopf's 0.71044609, exact to 1e-6 there.
double flux(double optical_thickness) {
    if (optical_thickness > 10.0) return (4.0 / 3.0) / (optical_thickness + 2.0 * 0.71044609);
    const auto name = "slab_RE_black_Q_tau" + std::to_string(int(optical_thickness));
    return test::reference_value(test::reference("4abc_slab"), name);
}

// Mean of H over points about the middle of the wall at z.
double incident(const Solution& solution, double width, double z) {
    const Probe probe(solution, {.rays = 4096});
    double sum = 0.0;
    for (const double dx : {-0.3, 0.05, 0.35})
        for (const double dy : {-0.25, 0.1, 0.3})
            sum += probe
                       .on_surface({0.5 * width + dx, 0.5 * width + dy, z},
                                   {0, 0, z > 0.5 ? -1.0 : 1.0})
                       .irradiance[0];
    return sum / (9.0 * std::numbers::pi);
}

}  // namespace

TEST_CASE("Slabs: flux through optical thicknesses of 1 to 20", "[solution][long]") {
    for (const double thickness : {1.0, 5.0, 20.0}) {
        const double expected = flux(thickness);
        // Flux is a small difference in thick slabs: what is 1 % of it is less of the solution. An
        // emitter that stands in a thick medium lights a thin layer of it: through the rows, as all
        // other light.
        const Solution solution = solve_adaptively(
            slab(thickness), {.error = 0.016 * expected, .direct_light = DirectLightMode::rows});
        const double width = width_of(thickness);
        const double into_cold = incident(solution, width, 1.0);
        const double out_of_hot = 1.0 - incident(solution, width, 0.0);
        INFO("optical thickness " << thickness << ": " << into_cold / expected - 1.0 << " and "
                                  << out_of_hot / expected - 1.0 << " off, "
                                  << solution.report.zones << " zones");
        CHECK(into_cold == Approx(expected).epsilon(0.01));
        CHECK(out_of_hot == Approx(expected).epsilon(0.01));
    }
}
