// Light that arrives in media and on surfaces, by source iteration from a solution.
#include "render/arriving_light.h"

#include <numbers>

#include "radiosity/adaptive.h"
#include "render/last_scatter.h"
#include "render/two_pass.h"
#include "support/catch.h"
#include "support/furnace.h"
#include "support/path_scenes.h"

using namespace tyndall;
using std::numbers::pi;

namespace {

radiosity::Scene forward_slit() {
    auto scene = test::slit_room();
    scene.media[0].asymmetry = 0.7;
    scene.media[0].extinction = {0.5};
    return scene;
}

radiosity::Solution solved(std::shared_ptr<const radiosity::Enclosure> enclosure,
                           radiosity::DirectLightMode mode) {
    radiosity::SolveOptions options;
    options.error = 0.1;
    options.refinement = radiosity::Refinement::adaptive;
    options.max_elements = 1500;
    options.rays = options.gather_rays = 64;
    options.direct_light = mode;
    return radiosity::solve_adaptively(std::move(enclosure), options);
}

// All pixels of a fine cube: on_pixel(direction, share of all directions).
template <class OnPixel>
void for_directions(OnPixel&& on_pixel) {
    for (const auto& face : radiosity::full_cube_faces(24))
        for (std::size_t j = 0; j < face.nv; ++j)
            for (std::size_t i = 0; i < face.nu; ++i)
                on_pixel(glm::normalize(face.direction(i, j)), face.weights[j * face.nu + i]);
}

}  // namespace

// With light of radiance 1 from everywhere no scattering, through whatever extinction, changes
// anything.
TEST_CASE("Source iteration: a furnace stays one", "[long]") {
    auto enclosure = radiosity::make_enclosure(forward_slit());
    test::make_furnace(enclosure);
    const auto solution = solved(std::make_shared<const radiosity::Enclosure>(enclosure),
                                 radiosity::DirectLightMode::rows);
    const std::size_t sweeps = GENERATE(1, 2);
    const render::ArrivingLight light(solution, {.resolution = 6, .sweeps = sweeps});
    REQUIRE(light.order() > 3);
    std::vector<double> weights;
    double worst_q = 0.0, worst_beyond = 0.0, value = 0.0, again = 0.0;
    std::size_t groups = 0, sides = 0;
    for (std::size_t z = 0; z < solution.forest.zone_count(); ++z) {
        const mesh::ZoneId zone(z);
        if (!light.group(zone)) continue;
        ++groups;
        const auto x = solution.forest.centroid(zone);
        light.weigh(0, glm::normalize(mesh::Direction(0.3, -0.5, 0.8)), weights);
        light.shares(zone, weights, x, x, {&value, 1}, {&again, 1});
        worst_q = std::max(worst_q, std::abs(value - 1.0));
    }
    for (std::size_t f = 0; f < enclosure.mesh.facets.size(); ++f) {
        if (enclosure.facet_sides[f][0] == radiosity::none) continue;
        ++sides;
        const mesh::FacetId facet(f);
        const auto x = solution.forest.centroid(mesh::root_patch(facet, mesh::Side::front));
        light.beyond(facet, mesh::Side::front, x, {&value, 1});
        worst_beyond = std::max(worst_beyond, std::abs(value));
    }
    REQUIRE(groups > 20);
    REQUIRE(sides > 10);
    // Integrals of harmonics over pixels are sums over 16 points of each: evenly bright directions
    // have some light in orders above 0, which zones send on.
    CHECK(worst_q < 1e-3);
    CHECK(worst_beyond < 0.1 * 1e-3);  // a tenth of what arrives on walls is scattered light
}

TEST_CASE("Turned sources: direct light goes elsewhere, and none is lost") {
    const auto solution =
        solved(test::enclosed(forward_slit()), radiosity::DirectLightMode::closed_form);
    const auto whole = render::with_whole_extinction(*solution.enclosure);
    const render::PathMedia media(*solution.enclosure);
    const render::TurnedSources sources(solution, whole, media);
    const radiosity::DirectLight light(whole), reduced(*solution.enclosure);
    double bright = 0.0;
    for_directions(
        [&](mesh::Direction d, double share) { bright += share * sources.brightness(d); });
    CHECK(bright == Approx(1.0).epsilon(0.002));  // a cube of 24 pixels and a lobe of g = 0.7
    std::size_t looked = 0;
    for (std::size_t z = 0; z < solution.forest.zone_count() && looked < 10; z += 5) {
        const mesh::ZoneId zone(z);
        if (!solution.forest.is_leaf(zone) || whole.solid(solution.forest.base_tet(zone))) continue;
        const auto x = solution.forest.centroid(zone);
        double by_whole = 0.0, by_reduced = 0.0;
        light.at_zone(x, solution.forest.base_tet(zone), {&by_whole, 1});
        reduced.at_zone(x, solution.forest.base_tet(zone), {&by_reduced, 1});
        if (!(by_reduced > 0.0)) continue;
        ++looked;
        double even[2] = {0.0, 0.0};
        for_directions([&](mesh::Direction d, double share) {
            even[0] += share * sources.direct(zone, 0, d, render::Coefficients::whole);
            even[1] += share * sources.direct(zone, 0, d, render::Coefficients::reduced);
        });
        const double albedo = media.albedo(0, 0);
        CHECK(even[0] == Approx(albedo * by_whole / by_reduced).epsilon(0.002));  // as above
        CHECK(even[1] == Approx(albedo).epsilon(0.002));
    }
    CHECK(looked == 10);
}

// A wall beside the spot that a lamp throws through fog: what is scattered forwards on the way
// arrives there, and the solve has it in the spot.
TEST_CASE("Source iteration: surfaces get what paths bring them", "[long]") {
    const auto solution =
        solved(test::enclosed(forward_slit()), radiosity::DirectLightMode::closed_form);
    render::Camera camera = test::narrow_camera({0.3, 0.4, 1.0}, {0.9, 1.0, 0.0});
    camera.fov_x = 2.0;
    const auto last = render::last_scatter(solution, camera, {.samples = 64});
    const auto two = render::two_pass(solution, camera, {.samples = 1024});
    for (const char* layer : {"surfaces_direct", "surfaces_indirect", "multiple_scattering"}) {
        const auto expected = test::over(two, layer);
        const double found = test::over(last, layer).mean;
        INFO(layer << " " << found << " for " << expected.mean << ", noise of " << expected.error);
        // Two sweeps and three scatterings are the same light, but for a coarse solution's own
        // error, which paths take from a bounce further away: 2 %.
        CHECK(std::abs(found - expected.mean) <
              std::hypot(4.5 * expected.error, 0.02 * expected.mean));
        CHECK(expected.error < 0.03 * expected.mean);  // what light that paths find may be off by
    }
}
