// Bands walk, gather and are lit together: each must be what it is alone.
#include <cmath>

#include "radiosity/adaptive.h"
#include "support/catch.h"
#include "support/rooms.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

constexpr std::size_t bands = 3;

// A foggy room with a lamp, a glowing wall, a sun through a window and a spot; nothing is alike in
// two bands.
Scene coloured_room(bool varying) {
    Scene scene;
    scene.bands = bands;
    scene.materials = {test::material(0.5), test::material(0.0), test::material(0.2)};
    scene.materials[0].reflectance = {0.7, 0.5, 0.1};
    scene.materials[1].reflectance = {0.0, 0.1, 0.2};
    scene.materials[1].emission = {10.0, 20.0, 5.0};
    scene.materials[2].reflectance = {0.2, 0.8, 0.4};
    scene.materials[2].emission = {1.0, 0.0, 3.0};
    test::add_surfaces(scene, "room", mesh::room({0, 0, 0}, {2, 1, 1}), 0);
    test::add_surfaces(scene, "shelf", mesh::rectangle({0.9, 0, 0}, {0, 1, 0}, {0, 0, 0.6}), 0);
    test::add_surfaces(scene, "lamp", mesh::rectangle({0.3, 0.3, 1}, {0, 0.4, 0}, {0.4, 0, 0}), 1);
    test::add_surfaces(scene, "glow", mesh::rectangle({2, 0.3, 0.3}, {0, 0, 0.4}, {0, 0.4, 0}), 2);
    scene.media = {test::medium(0.4, 0.7)};
    Medium& fog = scene.media[0];
    fog.extinction = {0.4, 2.0, 0.9};
    fog.albedo = {0.7, 0.9, 0.2};
    fog.emission = {0.5, 0.0, 1.0};
    if (varying) {
        // Two bands share a shape, the third has its own.
        const ExtinctionShape of_height{[](Point p) { return 0.2 + p.z; }};
        const ExtinctionShape of_place{[](Point p) { return 1.5 - 0.5 * p.x + p.y * p.z; }};
        fog.shape = {of_height, of_height, of_place};
    }
    Light spot;
    spot.name = "spot";
    spot.source = SpotLight{{1.5, 0.5, 0.9}, {0, 0, -1}, {2.0, 1.0, 4.0}, 0.8, 0.1};
    scene.lights = {spot};
    return scene;
}

// The same with one band of it.
Scene only(Scene scene, std::size_t band) {
    const auto keep = [&](Spectrum& values) {
        if (!values.empty()) values = {values[band]};
    };
    scene.bands = 1;
    for (Material& m : scene.materials) {
        keep(m.reflectance);
        keep(m.emission);
    }
    for (Medium& m : scene.media) {
        keep(m.extinction);
        keep(m.albedo);
        keep(m.emission);
        if (!m.shape.empty()) m.shape = {m.shape[band]};
    }
    for (Light& light : scene.lights) keep(std::get<SpotLight>(light.source).intensity);
    return scene;
}

Solution solve(const Scene& scene, DirectLightMode mode, Radiance radiance) {
    SolveOptions options;
    options.refinement = Refinement::none;
    options.direct_light = mode;
    options.radiance = radiance;
    options.solver_tolerance = 1e-9;
    options.rays = 64;
    options.gather_rays = 64;
    return solve_adaptively(std::make_shared<const Enclosure>(make_enclosure(scene)), options);
}

// Relative root mean square difference between a band of `whole` and the only one of `grey`.
double difference(std::span<const double> whole, std::size_t band, std::span<const double> grey) {
    REQUIRE(whole.size() == bands * grey.size());
    double error = 0.0, square = 0.0;
    for (std::size_t k = 0; k < grey.size(); ++k) {
        error += std::pow(whole[k * bands + band] - grey[k], 2);
        square += grey[k] * grey[k];
    }
    REQUIRE(square > 0.0);
    return std::sqrt(error / square);
}

std::vector<double> at_centroids(const Solution& s, const Fields& fields) {
    std::vector<double> values;
    const Elements leaves = elements_of_leaves(*s.enclosure, s.forest);
    for (const PatchId patch : leaves.patches)
        for (std::size_t b = 0; b < s.enclosure->bands; ++b)
            values.push_back(fields.at(patch, b).at(s.forest.centroid(patch)));
    for (const ZoneId zone : leaves.zones)
        for (std::size_t b = 0; b < s.enclosure->bands; ++b)
            values.push_back(fields.at(zone, b).at(s.forest.centroid(zone)));
    return values;
}

}  // namespace

TEST_CASE("Each band of a solution by rows alone is the grey solution of its optics", "[bands]") {
    const auto radiance = GENERATE(Radiance::constant, Radiance::linear);
    Scene scene = coloured_room(false);
    scene.lights.clear();
    const Solution whole = solve(scene, DirectLightMode::rows, radiance);
    const auto indirect = at_centroids(whole, whole.indirect);
    for (std::size_t b = 0; b < bands; ++b) {
        const Solution grey = solve(only(scene, b), DirectLightMode::rows, radiance);
        CAPTURE(int(radiance), b);
        // Rows are the same to the bit, and the solver is left with 1e-9. Gathers add up in single
        // precision.
        CHECK(difference(whole.coarse.radiance, b, grey.coarse.radiance) < 1e-8);
        CHECK(difference(whole.coarse.incident, b, grey.coarse.incident) < 1e-8);
        CHECK(difference(indirect, b, at_centroids(grey, grey.indirect)) < 1e-5);
    }
}

TEST_CASE("Each band of a solution with direct light is the grey one, nearly", "[bands][long]") {
    const bool varying = GENERATE(false, true);
    const Scene scene = coloured_room(varying);
    const Solution whole = solve(scene, DirectLightMode::closed_form, Radiance::linear);
    const auto direct = at_centroids(whole, whole.direct);
    const auto indirect = at_centroids(whole, whole.indirect);
    for (std::size_t b = 0; b < bands; ++b) {
        const Solution grey = solve(only(scene, b), DirectLightMode::closed_form, Radiance::linear);
        CAPTURE(varying, b);
        // Bands decide together, by their mean, what is small enough to be taken as one, and where
        // the centre of a zone of smoke is: that is what a band alone does otherwise.
        CHECK(difference(whole.coarse.radiance, b, grey.coarse.radiance) < 0.01);
        CHECK(difference(whole.coarse.incident, b, grey.coarse.incident) < 0.01);
        CHECK(difference(direct, b, at_centroids(grey, grey.direct)) < 0.01);
        CHECK(difference(indirect, b, at_centroids(grey, grey.indirect)) < 0.01);
    }
}
