// Given fluxes and heat, adiabatic walls, radiative equilibrium: temperatures and fluxes that are
// known in closed form, at any number of rays.
#include <cmath>
#include <numbers>

#include "radiosity/adaptive.h"
#include "radiosity/temperatures.h"
#include "support/catch.h"
#include "support/rooms.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

using std::numbers::pi;

double black(double temperature) {
    return stefan_boltzmann * std::pow(temperature, 4) / pi;
}

Material hot(double reflectance, double temperature) {
    Material m = test::material(reflectance, (1.0 - reflectance) * black(temperature));
    m.emits = EmittingSides::both;
    return m;
}

Material with_flux(double reflectance, double flux) {
    Material m = test::material(reflectance);
    m.flux = {flux};
    m.emits = EmittingSides::both;
    return m;
}

// A unit cube of material 0, whose floor is of material 1.
Scene cube(const Material& walls, const Material& floor) {
    Scene scene;
    scene.thermal = true;
    scene.materials = {walls, floor};
    test::add_surfaces(scene, "cube", mesh::room({0, 0, 0}, {1, 1, 1}), 0);
    scene.surfaces[test::surface_named(scene, "cube.floor")].material = 1;
    return scene;
}

const SolveOptions quick_heat{
    .refinement = Refinement::none, .rays = 64, .gather_rays = 64, .solver_tolerance = 1e-9};

// Nothing is sampled but rows, which close: what is 1 everywhere is so exactly.
SolveOptions in_rows() {
    SolveOptions options = quick_heat;
    options.direct_light = DirectLightMode::rows;
    return options;
}

Solution solve_heat(const Scene& scene, const SolveOptions& options = quick_heat) {
    return solve_adaptively(std::make_shared<const Enclosure>(make_enclosure(scene)), options);
}

void all_at(const Solution& s, const std::string& name, double temperature, double tolerance) {
    const auto& range = s.report.temperature.at(name);
    INFO(name << ": " << range.lowest << " to " << range.highest << " K for " << temperature);
    CHECK(range.mean == Approx(temperature).epsilon(tolerance));
    CHECK(range.lowest == Approx(temperature).epsilon(tolerance));
    CHECK(range.highest == Approx(temperature).epsilon(tolerance));
}

}  // namespace

TEST_CASE("A wall of given flux among black walls of one temperature", "[heat]") {
    // It sees nothing but σT1⁴/π, whatever its form: q = ε σ (T⁴ − T1⁴).
    for (const double flux : {0.0, 2e4, -1e4})
        for (const double reflectance : {0.0, 0.6}) {
            const Solution s = solve_heat(cube(hot(0.0, 1000.0), with_flux(reflectance, flux)));
            const double fourth =
                std::pow(1000.0, 4) + flux / ((1.0 - reflectance) * stefan_boltzmann);
            INFO("flux " << flux << ", reflectance " << reflectance);
            // Direct light of the hot walls, in closed form on every leaf.
            all_at(s, "cube.floor+", std::pow(fourth, 0.25), 1e-4);
            CHECK(s.report.net_flux.at("cube.floor+")[0] == Approx(flux).margin(1e-3));
            CHECK(s.report.net_power.at("cube.floor+")[0] == Approx(flux).margin(1e-3));
            all_at(s, "cube.x0+", 1000.0, 1e-9);
            CHECK(std::abs(s.report.energy_balance) < 0.01);
        }
}

TEST_CASE("A medium in equilibrium with its walls, or heated in a cold box", "[heat]") {
    for (const double albedo : {0.0, 0.7}) {
        Scene scene = cube(hot(0.3, 800.0), with_flux(0.5, 0.0));
        scene.media = {test::medium(2.0, albedo)};
        scene.media[0].heat = {0.0};
        const Solution even = solve_heat(scene, in_rows());
        // One temperature all over: a furnace, exact to the single precision of rows.
        all_at(even, "haze", 800.0, 1e-6);
        all_at(even, "cube.floor+", 800.0, 1e-6);
        CHECK(even.report.flux_divergence.at("haze")[0] == Approx(0.0).margin(1e-3));

        scene = cube(test::material(0.0), test::material(0.0));
        scene.thermal = true;
        scene.media = {test::medium(2.0, albedo)};
        scene.media[0].heat = {5000.0};
        const Solution heated = solve_heat(scene);
        CHECK(heated.report.flux_divergence.at("haze")[0] == Approx(5000.0).epsilon(1e-6));
        CHECK(heated.report.net_power.at("haze")[0] == Approx(5000.0).epsilon(1e-6));
        CHECK(std::abs(heated.report.energy_balance) < 0.02);  // 64 rays are not reciprocal
        // Q = 4 π κ_a (J_e − H): scattering makes the same heat need a hotter medium.
        const Elements leaves = elements_of_leaves(*heated.enclosure, heated.forest);
        for (const ZoneId zone : leaves.zones) {
            const Point x = heated.forest.centroid(zone);
            const double h = heated.direct.at(zone, 0).at(x) + heated.indirect.at(zone, 0).at(x);
            const double expected = h + 5000.0 / (4.0 * pi * 2.0 * (1.0 - albedo));
            CHECK(black(temperature_of(heated, zone)) == Approx(expected).epsilon(1e-9));
        }
        CHECK(heated.report.temperature.at("cube.x0+").highest == 0.0);
    }
}

TEST_CASE("A thin heated medium is as hot as its own heat says", "[heat]") {
    // κ → 0: nothing comes back, Q = 4 κ σT⁴.
    Scene scene = cube(test::material(0.0), test::material(0.0));
    scene.media = {test::medium(1e-4, 0.0)};
    scene.media[0].heat = {10.0};
    // κ times the mean chord of the cube, 2/3 m, is what does.
    all_at(solve_heat(scene), "haze", std::pow(10.0 / (4e-4 * stefan_boltzmann), 0.25), 1e-4);
}

TEST_CASE("Each side of an adiabatic sheet has the temperature of what it sees", "[heat]") {
    // An adiabatic sheet across a black box, one half at T1, the other at T2: with black walls both
    // sides of it see one temperature each, and none lets anything through: the sides are two
    // walls.
    Scene scene = cube(hot(0.0, 900.0), hot(0.0, 900.0));
    scene.materials.push_back(with_flux(0.4, 0.0));
    test::add_surfaces(scene, "sheet", mesh::rectangle({0, 0, 0.5}, {1, 0, 0}, {0, 1, 0}), 2);
    const Solution s = solve_heat(scene);
    all_at(s, "sheet+", 900.0, 1e-4);
    all_at(s, "sheet-", 900.0, 1e-4);
}

TEST_CASE("A sink that asks for more than there is has no temperature, and says so", "[heat]") {
    const Solution s =
        solve_heat(cube(hot(0.0, 300.0), with_flux(0.0, -1000.0)));  // σT⁴ = 459 W/m²
    CHECK(!s.report.temperature.contains("cube.floor+"));
    const auto& warnings = s.report.warnings;
    CHECK(std::ranges::any_of(warnings, [](const std::string& w) {
        return w.find("\"cube.floor+\" is to take up more heat than arrives") != std::string::npos;
    }));
}

TEST_CASE("A selective wall of given flux in several bands", "[heat]") {
    // Σ ε_b f_b(T) σT⁴ = Σ ε_b f_b(T1) σT1⁴ + q: what the wall sees is black at T1 in every band.
    Scene scene;
    scene.bands = 3;
    scene.spectral.band_edges = {0.0, 3e-6, 6e-6, infinity};
    const double t1 = 1100.0;
    Material walls = test::material(0.0);
    walls.reflectance = {0.0, 0.0, 0.0};
    walls.emission = black_radiance(scene.spectral, 3, t1);
    const std::vector<double> emissivity{0.9, 0.3, 0.1};
    for (const double flux : {0.0, 1.5e4, -6e3}) {
        Material floor = with_flux(0.0, flux);
        floor.reflectance = {0.1, 0.7, 0.9};
        Scene whole = cube(walls, floor);
        whole.bands = scene.bands;
        whole.spectral = scene.spectral;
        const Solution s = solve_heat(whole);
        double total = flux / pi;
        for (std::size_t b = 0; b < 3; ++b) total += emissivity[b] * walls.emission[b];
        const double expected = temperature_of(scene.spectral, emissivity, total);
        REQUIRE(s.report.solver.converged);
        INFO("flux " << flux);
        // Direct light of the black walls in closed form, at points on every element.
        all_at(s, "cube.floor+", expected, 1e-4);
        double net = 0.0;
        for (const double q : s.report.net_flux.at("cube.floor+")) net += q;
        CHECK(net == Approx(flux).margin(1.0));  // of 83 kW/m²
        CHECK(std::abs(s.report.energy_balance) < 0.01);
    }
}

TEST_CASE("Within an element that settles, the temperature is that of the point", "[heat]") {
    // What a point takes up it emits again, as in (44): black at T, and the element at another.
    SurfaceSide side;
    side.emissivity = {0.8, 0.25};
    side.reflectance = {0.2, 0.75};
    side.settled_flux = 0.0;
    const SpectralModel model{{0.0, 3e-6, infinity}};
    const auto element = black_radiance(model, 2, 700.0), point = black_radiance(model, 2, 900.0);
    const Spectrum emission{0.8 * element[0], 0.25 * element[1]};
    CHECK(temperature_there(model, side, emission, element) == Approx(700.0).epsilon(1e-9));
    CHECK(temperature_there(model, side, emission, point) == Approx(900.0).epsilon(1e-9));
    // A flux of its own comes on top.
    side.settled_flux = pi * (0.8 * (point[0] - element[0]) + 0.25 * (point[1] - element[1]));
    CHECK(temperature_there(model, side, emission, element) == Approx(900.0).epsilon(1e-9));
    // Where a temperature is given, what falls on the point does not count.
    side.settled_flux.reset();
    CHECK(temperature_there(model, side, emission, point) == Approx(700.0).epsilon(1e-9));

    MediumOptics medium;
    medium.extinction = {2.0, 0.5};
    medium.albedo = {0.0, 0.2};
    medium.absorption = {2.0, 0.4};
    medium.settled_heat = 0.0;
    CHECK(temperature_there(model, medium, {{0.0, 0.0}}, point) == Approx(900.0).epsilon(1e-9));
}

TEST_CASE("Bands that are all alike settle as one grey band does", "[heat]") {
    // Hot and cold black faces, grey adiabatic walls, a grey medium in equilibrium: in three bands
    // of the same properties the sums over bands obey the grey equation.
    const auto scene = [](std::size_t bands) {
        Scene result;
        result.bands = bands;
        if (bands > 1) result.spectral.band_edges = {0.0, 3e-6, 8e-6, infinity};
        const auto of = [&](double reflectance, double temperature) {
            Material m;
            m.reflectance.assign(bands, reflectance);
            m.emission = black_radiance(result.spectral, bands, temperature);
            for (double& e : m.emission) e *= 1.0 - reflectance;
            return m;
        };
        Material adiabatic = of(0.4, 0.0);
        adiabatic.emission.clear();
        adiabatic.flux = {0.0};
        result.materials = {adiabatic, of(0.0, 1500.0), of(0.2, 500.0)};
        test::add_surfaces(result, "cube", mesh::room({0, 0, 0}, {1, 1, 1}), 0);
        result.surfaces[test::surface_named(result, "cube.floor")].material = 1;
        result.surfaces[test::surface_named(result, "cube.ceiling")].material = 2;
        Medium gas = test::medium(3.0, 0.0);
        gas.extinction.assign(bands, 3.0);
        gas.albedo.assign(bands, 0.25);
        gas.heat = {2e4};
        result.media = {gas};
        return result;
    };
    const Solution grey = solve_heat(scene(1), in_rows()), three = solve_heat(scene(3), in_rows());
    REQUIRE(three.report.solver.converged);
    for (const auto& [name, power] : grey.report.net_power) {
        double sum = 0.0;
        for (const double p : three.report.net_power.at(name)) sum += p;
        INFO(name << ": " << sum << " for " << power[0]);
        CHECK(sum == Approx(power[0]).margin(1.0));  // of 287 kW that the floor emits
    }
    // Elements of the coarse solution hold one temperature in three bands, leaves' own in one: no
    // more than the means agree.
    for (const auto& [name, range] : grey.report.temperature) {
        INFO(name);
        CHECK(three.report.temperature.at(name).mean == Approx(range.mean).epsilon(0.01));
    }
}
