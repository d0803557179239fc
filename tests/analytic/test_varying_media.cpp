// Media whose extinction varies in space: closed forms, and identities that hold whatever varies.
#include <algorithm>
#include <glm/geometric.hpp>
#include <numbers>

#include "radiosity/adaptive.h"
#include "radiosity/exchange_walked.h"
#include "radiosity/probe.h"
#include "support/catch.h"
#include "support/furnace.h"
#include "support/rooms.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

using std::numbers::pi;
using Function = std::function<double(Point)>;

Medium varying(const Function& extinction, double albedo) {
    Medium m = test::medium(1.0, albedo);
    m.shape.push_back({extinction, {}});
    return m;
}

std::shared_ptr<const Enclosure> enclosed(const Scene& scene) {
    return std::make_shared<const Enclosure>(make_enclosure(scene));
}

// Few elements and rays: what is tested is exact at any number.
const SolveOptions quick_walks{.refinement = Refinement::none,
                               .direct_light = DirectLightMode::rows,
                               .rays = 64,
                               .gather_rays = 64,
                               .solver_tolerance = 1e-9};

double departure_from(const std::vector<double>& values, double expected) {
    double most = 0.0;
    for (const double v : values) most = std::max(most, std::abs(v - expected));
    return most;
}

}  // namespace

TEST_CASE("Burns & Christon's cube: flux divergence on the axis", "[solution]") {
    // A cube of 1 m about the origin, cold black walls, absorption alone, σT⁴ = 1. The figures are
    // Burns & Christon's (1997); with one J_e they are κ/π ∫ exp(−τ to the wall) dω, and a sum over
    // 320 000 directions gives the same to 2e-5.
    Scene scene;
    scene.materials = {test::material(0.0)};
    test::add_surfaces(scene, "walls", mesh::room({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}), 0);
    const auto extinction = [](Point p) {
        return 0.9 * (1.0 - 2.0 * std::abs(p.x)) * (1.0 - 2.0 * std::abs(p.y)) *
                   (1.0 - 2.0 * std::abs(p.z)) +
               0.1;
    };
    scene.media = {varying(extinction, 0.0)};
    scene.media[0].emission = {1.0 / pi};
    const Solution solution = solve_adaptively(
        enclosed(scene), {.refinement = Refinement::none, .element_size = 0.25, .gather_rays = 16});
    const Probe probe(solution, {.rays = 4096});
    const double expected[]{3.07561, 2.57196, 2.08181, 1.56180, 0.99443, 0.37165};
    for (int k = 0; k <= 5; ++k) {
        const Point x(std::min(0.1 * k, 0.5 - 1e-9), 0.0, 0.0);
        const double incident = probe.in_space(x).incident[0];
        const double divergence = extinction(x) * (4.0 - incident);  // κ (4π J_e − G)
        INFO("x = " << x.x << ": " << divergence << ", " << divergence / expected[k] - 1.0
                    << " off");
        // The figures' own last digit, and what 4096 rays leave; J is uniform, so that elements
        // leave nothing: 2e-5 at most was measured.
        CHECK(divergence == Approx(expected[k]).epsilon(1e-4));
    }
    // Its integral over the cube is what the walls take in.
    const double lost = solution.report.net_power.at("haze")[0];
    CHECK(lost > 0.0);
    CHECK(std::abs(solution.report.energy_balance) < 0.01);
    INFO(solution.report.zones << " zones, power " << lost);
}

TEST_CASE("Varying media: the furnace and closure hold exactly", "[furnace][long]") {
    const Function functions[]{
        [](Point p) { return std::exp(-2.0 * p.z) * (1.0 + std::sin(3.0 * p.x)); },
        // Nothing in half of the room, and a ball of smoke.
        [](Point p) { return std::max(0.0, p.x - 1.4); },
        [](Point p) { return 5.0 * std::max(0.0, 0.3 - glm::distance(p, Point(2, 1, 1))); }};
    for (const auto& function : functions)
        for (const double detail : {0.0, 5.0}) {
            if (detail > 0.0 && &function != &functions[1]) continue;
            Scene scene = test::slit_room();
            scene.media = {varying(function, 0.9)};
            Enclosure e = make_enclosure(scene);
            test::make_furnace(e);
            SolveOptions options = quick_walks;
            options.row_detail = detail;
            const Solution solution =
                solve_adaptively(std::make_shared<const Enclosure>(std::move(e)), options);
            INFO("detail " << detail << ", function " << &function - functions);
            // As in uniform media (test_furnace.cpp): rows in single precision, 1/(1 − a).
            CHECK(departure_from(solution.coarse.radiance, 1.0) < 1e-6);
            CHECK(departure_from(solution.coarse.incident, 1.0) < 1e-6);
            CHECK(solution.report.closure_error < 1e-7);
            const Probe probe(solution, {.rays = 64});
            for (const Point x : {Point(0.3, 0.4, 0.5), Point(2.0, 1.0, 1.0)})
                CHECK(probe.in_space(x).incident[0] == Approx(4.0 * pi).epsilon(1e-6));
        }
}

TEST_CASE("Varying media: a constant function is the number, to the bit", "[solution]") {
    Scene number = test::slit_room(), function = number;
    function.media = {varying([](Point) { return 0.25; }, 0.9)};
    const auto e = enclosed(function);
    CHECK(e->media[0].varying.empty());
    CHECK(e->media[0].extinction == enclosed(number)->media[0].extinction);
    CHECK(e->media[0].absorption == enclosed(number)->media[0].absorption);
    // A grid of equal values is another way through the code to the same light: single precision
    // of its values and of distances along rays.
    Scene grid = number;
    grid.media[0].extinction = {1.0};
    grid.media[0].shape.push_back(
        {std::make_shared<const RegularGrid>(std::array<std::size_t, 3>{4, 3, 5}, Point(-1, -1, -1),
                                             Point(4, 3, 3), std::vector<float>(60, 0.25f)),
         {}});
    const Solution a = solve_adaptively(enclosed(number), quick_walks);
    const Solution b = solve_adaptively(enclosed(grid), quick_walks);
    REQUIRE(a.coarse.radiance.size() == b.coarse.radiance.size());
    const double most = *std::max_element(a.coarse.radiance.begin(), a.coarse.radiance.end());
    double departs = 0.0;
    for (std::size_t k = 0; k < a.coarse.radiance.size(); ++k)
        departs = std::max(departs, std::abs(a.coarse.radiance[k] - b.coarse.radiance[k]));
    CHECK(departs < 1e-5 * most);
}

TEST_CASE("Varying media: between plates only the optical depth counts", "[exchange]") {
    // κ(z) with ∫κ dz = 1 over 1 m: the same rays from floor to ceiling lose the same.
    const auto plates = [](Medium medium) {
        Scene scene;
        scene.materials = {test::material(0.5)};
        test::add_surfaces(scene, "box", mesh::room({0, 0, 0}, {2, 2, 1}), 0);
        scene.media = {std::move(medium)};
        const Enclosure e = make_enclosure(scene);
        const Forest forest(e.mesh);
        const Elements elements = elements_of_leaves(e, forest);
        const auto rows = all_rows(exchange_walked, {e, forest, elements},
                                   {.rays = 256, .settings = {}, .progress = {}});
        const auto name = [&](std::size_t i) { return name_of(e, forest, elements, ElementId(i)); };
        double sum = 0.0;
        for (std::size_t i = 0; i < elements.patches.size(); ++i)
            for (std::size_t k = rows.starts[i]; k < rows.starts[i + 1]; ++k)
                if (name(i) == "box.floor+" && name(rows.columns[k]) == "box.ceiling+")
                    sum += rows.value(k);
        return sum;
    };
    const double uniform = plates(test::medium(1.0, 0.5));
    const Function functions[]{[](Point p) { return 2.0 * p.z; }, [](Point p) { return 1.5 - p.z; },
                               [](Point p) { return 3.0 * p.z * p.z; }};
    for (const auto& function : functions) {
        INFO("function " << &function - functions);
        // What is linear is exact but for single precision; of 3 z² the grid's cells of 1/32 m
        // make h²/2 = 5e-4 too much.
        CHECK(plates(varying(function, 0.5)) ==
              Approx(uniform).epsilon(&function - functions < 2 ? 1e-5 : 1e-3));
    }
}

TEST_CASE("Varying media: a slab in optical depths is the uniform slab", "[solution][long]") {
    // Radiative equilibrium between black plates, τ = 1, κ = 0.4 + 1.2 z, white sides 3 m apart:
    // the flux is the uniform slab's (tests/analytic/test_slabs.cpp).
    const auto flux = [](Medium medium) {
        Scene scene;
        scene.materials = {test::material(1.0), test::material(0.0, 1.0), test::material(0.0)};
        test::add_surfaces(scene, "box", mesh::room({0, 0, 0}, {4, 4, 1}), 0);
        scene.surfaces[test::surface_named(scene, "box.floor")].material = 1;
        scene.surfaces[test::surface_named(scene, "box.ceiling")].material = 2;
        scene.media = {std::move(medium)};
        const Solution s = solve_adaptively(enclosed(scene),
                                            {.error = 0.02, .direct_light = DirectLightMode::rows});
        const Probe probe(s, {.rays = 4096});
        double sum = 0.0;
        for (const double dx : {-0.3, 0.05, 0.35})
            sum += probe.on_surface({2.0 + dx, 2.0 - 0.7 * dx, 1.0}, {0, 0, -1.0}).irradiance[0];
        return sum / (3.0 * pi);
    };
    // 4abc: 0.5532 for the infinite slab. Both share geometry and rays; what is left is noise.
    const double uniform = flux(test::medium(1.0, 1.0));
    CHECK(flux(varying([](Point p) { return 0.4 + 1.2 * p.z; }, 1.0)) ==
          Approx(uniform).epsilon(0.01));
    CHECK(uniform == Approx(0.5532).epsilon(0.01));
}

TEST_CASE("Varying media: lengths times s with κ/s leave radiances unchanged", "[solution]") {
    const auto radiances = [](double s) {
        Scene scene = test::slit_room(s);
        scene.media = {varying(
            [s](Point p) { return (0.1 + 0.4 * std::exp(-p.z / s) + 0.1 * p.x / s) / s; }, 0.9)};
        auto options = quick_walks;
        options.direct_light = DirectLightMode::closed_form;
        return solve_adaptively(enclosed(scene), options).coarse.radiance;
    };
    const auto one = radiances(1.0), two = radiances(4.0);
    REQUIRE(one.size() == two.size());
    const double most = *std::max_element(one.begin(), one.end());
    // A power of two changes no digits but those of thresholds.
    for (std::size_t k = 0; k < one.size(); ++k)
        CHECK(two[k] == Approx(one[k]).margin(1e-9 * most));
}

TEST_CASE("Varying media: direct light through fog by height, against its closed form",
          "[direct_light]") {
    // κ = 2 exp(−z): τ along a path from z to z' that rises by h over its length s is
    // 2 s (e^−z − e^−z')/h.
    Scene scene;
    scene.materials = {test::material(0.5)};
    test::add_surfaces(scene, "room", mesh::room({0, 0, 0}, {2, 2, 2}), 0);
    scene.media = {varying([](Point p) { return 2.0 * std::exp(-p.z); }, 0.5)};
    scene.lights = {{"lamp", PointLight{{1.0, 1.0, 1.9}, {1.0}}, ""}};
    const auto e = enclosed(scene);
    const DirectLight light(*e);
    for (const Point x : {Point(0.2, 0.3, 0.1), Point(1.7, 0.4, 1.2), Point(1.0, 1.0, 0.5)}) {
        const Direction path = Point(1.0, 1.0, 1.9) - x;
        const double s = glm::length(path);
        const double depth = 2.0 * s * (std::exp(-x.z) - std::exp(-1.9)) / (1.9 - x.z);
        double incident = 0.0;
        light.at_zone(x, mesh::locate(e->mesh, x), {&incident, 1});
        // The grid's tolerance, 1e-3 of κ's largest value, on a path of a metre or two.
        CHECK(incident == Approx(std::exp(-depth) / (4.0 * pi * s * s)).epsilon(2e-3));
    }
}

TEST_CASE("Varying media: power balances, lit through an emitter and through rows",
          "[solution][long]") {
    Scene scene = test::slit_room();
    scene.media = {
        varying([](Point p) { return 1.5 * std::max(0.0, 1.0 - p.z); }, 0.8)};  // ends at 1 m
    const auto e = enclosed(scene);
    const Solution direct = solve_adaptively(e, {.error = 0.1, .max_elements = 6000, .rays = 128});
    // As in uniform media: direct light's mean over leaves, and the reciprocity of walked rows in
    // what is left.
    CHECK(std::abs(direct.report.direct_power_check) < 0.005);
    CHECK(std::abs(direct.report.energy_balance) < 0.01);
    CHECK(direct.report.net_power.at("haze")[0] < 0.0);  // it absorbs
    // All of the lamp through rows: with 256 rays four seeds leave 1 to 3 % in this medium, and 1
    // to 3 % in a uniform one.
    const Solution rows = solve_adaptively(e, {.start = Start::base,
                                               .refinement = Refinement::none,
                                               .direct_light = DirectLightMode::rows,
                                               .rays = 4096,
                                               .gather_rays = 4});
    CHECK(std::abs(rows.report.energy_balance) < 0.01);
    CHECK(rows.report.closure_error < 1e-7);
}
