// Slabs in radiative equilibrium between black walls, up to an optical thickness of 20: a box four
// times as wide as thick, whose sides are white. Far from the sides it is the infinite slab.
#include <numbers>

#include "radiosity/adaptive.h"
#include "radiosity/probe.h"
#include "support/catch.h"
#include "support/reference.h"
#include "support/rooms.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

constexpr double width = 3.0;  // [m]; the slab is 1 m thick

std::shared_ptr<const Enclosure> slab(double optical_thickness) {
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
double incident(const Solution& solution, double z) {
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

TEST_CASE("Slabs: flux through optical thicknesses of 1 to 20", "[solution]") {
    for (const double thickness : {1.0, 5.0, 10.0, 20.0}) {
        // Refined until neither wall's light is off: flux is a small difference in thick slabs, so
        // that the goal for the solution is far below the 1 % asked of the flux.
        const Solution solution = solve_adaptively(slab(thickness), {.error = 0.001});
        const double expected = flux(thickness);
        const double into_cold = incident(solution, 1.0),
                     out_of_hot = 1.0 - incident(solution, 0.0);
        INFO("optical thickness " << thickness << ": " << into_cold / expected - 1.0 << " and "
                                  << out_of_hot / expected - 1.0 << " off, "
                                  << solution.report.zones << " zones");
        CHECK(into_cold == Approx(expected).epsilon(0.01));
        CHECK(out_of_hot == Approx(expected).epsilon(0.01));
    }
}
