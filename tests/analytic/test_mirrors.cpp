// Mirrors that walks go on at, against scenes without any that must have the same light.
#include <numbers>

#include "radiosity/adaptive.h"
#include "radiosity/probe.h"
#include "support/catch.h"
#include "support/furnace.h"
#include "support/mirror_scenes.h"
#include "support/reference.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

std::shared_ptr<const Enclosure> with_mirrors(const Scene& scene,
                                              Mirrors mirrors = Mirrors::walked) {
    return std::make_shared<const Enclosure>(make_enclosure(scene, {.mirrors = mirrors}));
}

// A foggy box with all kinds of mirrors, one of which reflects everything and one of which is open
// to the sky beside it, all at one temperature.
std::shared_ptr<const Enclosure> mirror_furnace() {
    Scene scene;
    scene.materials = {test::material(0.5), test::mirror(1.0), test::mirror(0.6, 0.3),
                       test::mirror(0.95)};
    test::add_surfaces(scene, "room", mesh::room({0, 0, 0}, {2, 1, 1}), 0);
    const char* mirrors[] = {"room.x0", "room.floor", "room.y1"};
    for (std::size_t m = 0; m < 3; ++m)
        scene.surfaces[test::surface_named(scene, mirrors[m])].material = m + 1;
    test::add_surfaces(scene, "block", mesh::box({0.4, 0.3, 0.2}, {0.8, 0.6, 0.5}), 2);
    scene.media = {test::medium(0.7, 0.9)};
    Enclosure e = make_enclosure(scene);
    test::make_furnace(e);
    return std::make_shared<const Enclosure>(e);
}

const SolveOptions quick{.refinement = Refinement::none,
                         .direct_light = DirectLightMode::rows,
                         .rays = 64,
                         .gather_rays = 64,
                         .solver_tolerance = 1e-9};

// Where both boxes are probed, in space and on walls.
struct Values {
    std::vector<double> in_space, on_walls;
};

Values probed(const Solution& solution, std::size_t rays) {
    const Probe probe(solution, {.rays = rays});
    Values values;
    for (const double x : {0.15, 0.5, 0.9, 0.98})
        for (const double y : {0.2, 0.6})
            for (const double z : {0.1, 0.5, 0.8}) {
                values.in_space.push_back(probe.in_space({x, y, z}).incident[0]);
                values.on_walls.push_back(probe.on_surface({x, y, 0}, {0, 0, 1}).irradiance[0]);
                values.on_walls.push_back(probe.on_surface({0, y, z}, {1, 0, 0}).irradiance[0]);
            }
    return values;
}

double departure(const std::vector<double>& a, const std::vector<double>& b) {
    double square = 0.0, all = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        square += (a[k] - b[k]) * (a[k] - b[k]);
        all += b[k] * b[k];
    }
    return std::sqrt(square / all);
}

}  // namespace

TEST_CASE("Mirrors: a furnace is a furnace", "[furnace]") {
    const auto enclosure = mirror_furnace();
    const Solution solution = solve_adaptively(enclosure, quick);
    // As without mirrors: rows close to 1e-7 in single precision, and 1/(1 − a) makes up to a
    // hundred times that.
    CHECK(solution.report.closure_error < 1e-7);
    CHECK(test::largest_departure(solution.coarse.radiance) < 1e-6);
    CHECK(test::largest_departure(solution.coarse.incident) < 1e-6);
    // What is gathered, and interpolated. A mirror's own weight ends at 1e-4, and what is left is
    // taken to be like the rest.
    double most = 0.0;
    const Forest& forest = solution.forest;
    for (std::size_t z = 0; z < forest.zone_count(); ++z)
        if (forest.is_leaf(ZoneId(z)) && medium_of(*enclosure, forest, ZoneId(z)) != none)
            for (const auto v : forest[ZoneId(z)].corners)
                most = std::max(
                    most, std::abs(solution.indirect.at(ZoneId(z), 0).at(forest.point(v)) - 1.0));
    CHECK(most < 1e-5);
}

TEST_CASE("Mirrors: a furnace whose walls are split off", "[furnace][long]") {
    SolveOptions options = quick;
    options.direct_light = DirectLightMode::closed_form;
    const auto enclosure = mirror_furnace();
    const auto error = [&](std::size_t rays) {
        options.rays = rays;
        const Solution solution = solve_adaptively(enclosure, options);
        double square = 0.0, all = 0.0;
        for (std::size_t k = 0; k < solution.coarse.radiance.size(); ++k) {
            const double c = solution.coarse.elements.capacity[k];
            square += c * std::pow(solution.coarse.radiance[k] - 1.0, 2);
            all += c;
        }
        return std::sqrt(square / all);
    };
    const double few = error(64), many = error(1024);
    INFO(few << " with 64 rays, " << many << " with 1024");
    // What comes straight and what comes by mirrors no longer cancel ray by ray: noise of the rows.
    CHECK(few < 0.02);
    CHECK(many < 0.005);
    CHECK(many < 0.6 * few);
}

TEST_CASE("Mirrors: a box with a mirror is half of the doubled box", "[solution][long]") {
    const SolveOptions options{.error = 0.05, .element_size = 0.3, .max_elements = 8000};
    const Solution half = solve_adaptively(with_mirrors(test::mirrored_box(false)), options);
    const Solution whole = solve_adaptively(with_mirrors(test::mirrored_box(true)), options);
    const Values expected = probed(whole, 4096);
    const Values few = probed(half, 256), many = probed(half, 4096);
    const Values scattered = probed(
        solve_adaptively(with_mirrors(test::mirrored_box(false), Mirrors::scattered), options),
        4096);
    const double first = departure(few.in_space, expected.in_space);
    const double in_space = departure(many.in_space, expected.in_space);
    const double on_walls = departure(many.on_walls, expected.on_walls);
    INFO("in space " << first << " with 256 rays, " << in_space << " with 4096; on walls "
                     << departure(few.on_walls, expected.on_walls) << ", " << on_walls
                     << "; scattered evenly " << departure(scattered.in_space, expected.in_space)
                     << ", " << departure(scattered.on_walls, expected.on_walls));
    // The lamp's image is met by chance by a probe's rays; what is left with many of them is the
    // two solutions' own.
    CHECK(in_space < 0.5 * first);
    CHECK(in_space < 0.01);
    CHECK(on_walls < 0.01);
    CHECK(departure(scattered.on_walls, expected.on_walls) > 3.0 * on_walls);
    CHECK(std::abs(half.report.energy_balance) < 0.01);
    // Half of the power of both lamps is taken up on either side.
    CHECK(half.report.net_power.at("room.floor+")[0] ==
          Approx(0.5 * whole.report.net_power.at("room.floor+")[0]).epsilon(0.02));
    // A mirror that reflects all but a millionth takes up next to nothing.
    CHECK(std::abs(half.report.net_power.at("room.x1+")[0]) <
          1e-5 * half.report.net_power.at("lamp+")[0]);
}

// Of a slab in radiative equilibrium between black walls; for a thick one as in test_slabs.
static double slab_flux(double thickness) {
    if (thickness > 10.0) return (4.0 / 3.0) / (thickness + 2.0 * 0.71044609);
    return test::reference_value(test::reference("4abc_slab"),
                                 "slab_RE_black_Q_tau" + std::to_string(int(thickness)));
}

TEST_CASE("Mirrors: four mirrors around a column make the infinite slab", "[solution][long]") {
    for (const double thickness : {1.0, 5.0, 20.0}) {
        const double flux = slab_flux(thickness);
        Scene scene;
        scene.materials = {test::mirror(1.0), test::material(0.0, 1.0), test::material(0.0)};
        test::add_surfaces(scene, "box", mesh::room({0, 0, 0}, {0.1, 0.1, 1}), 0);
        scene.surfaces[test::surface_named(scene, "box.floor")].material = 1;
        scene.surfaces[test::surface_named(scene, "box.ceiling")].material = 2;
        scene.media = {test::medium(thickness, 1.0)};
        // Zones of an optical depth of 2 at most are thin enough where they hold linear J.
        const Solution solution =
            solve_adaptively(with_mirrors(scene), {.refinement = Refinement::uniform,
                                                   .direct_light = DirectLightMode::rows,
                                                   .element_size = 0.08});
        const Probe probe(solution, {.rays = 1024});
        double into_cold = 0.0, out_of_hot = 0.0;
        for (const double x : {0.02, 0.05, 0.09}) {
            const auto from = [&](double z, Direction n) {
                return probe.on_surface({x, 0.05, z}, n).irradiance[0] / std::numbers::pi;
            };
            into_cold += from(1, {0, 0, -1}) / 3.0;
            out_of_hot += (1.0 - from(0, {0, 0, 1})) / 3.0;
        }
        INFO("optical thickness " << thickness << ": " << into_cold / flux - 1.0 << " and "
                                  << out_of_hot / flux - 1.0 << " off, " << solution.report.zones
                                  << " zones");
        // As slabs in wide boxes (test_slabs).
        CHECK(into_cold == Approx(flux).epsilon(0.01));
        CHECK(out_of_hot == Approx(flux).epsilon(0.01));
    }
}
