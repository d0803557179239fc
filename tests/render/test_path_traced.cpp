// Followed paths against closed forms. Bounds are 4.5 of the samples' own standard errors (one in
// 150 000 by chance; seeds are fixed), unless something is exact.
#include "render/path_traced.h"

#include <numbers>

#include "mesh/input_error.h"
#include "radiosity/closed_forms.h"
#include "render/compare.h"
#include "render/light_paths.h"
#include "support/catch.h"
#include "support/furnace.h"
#include "support/path_scenes.h"

using namespace tyndall;
using std::numbers::pi;
using test::Estimate;

namespace {

constexpr double sigmas = 4.5;

radiosity::Light sun(mesh::Direction direction, double irradiance, double angle = 0.0) {
    return {"sun", radiosity::Sun{direction, {irradiance}, angle}};
}

// The mean over a narrow camera's picture of one layer.
Estimate seen(const radiosity::Scene& scene, mesh::Point eye, mesh::Point target,
              const std::string& layer, std::size_t samples = 64) {
    const auto image = render::path_traced(radiosity::make_enclosure(scene),
                                           test::narrow_camera(eye, target), {.samples = samples});
    return test::over(image, layer);
}

}  // namespace

TEST_CASE("Path traced: a rectangle's light on a floor is Lambert's") {
    radiosity::Scene scene = test::floor_room(0.6);
    scene.materials.push_back(test::material(0.0, 10.0));
    test::add_surfaces(scene, "lamp", mesh::rectangle({1, 1, 2.5}, {0, 1, 0}, {1.5, 0, 0}), 2);
    const mesh::Point x(1.2, 2.4, 0);
    std::vector<mesh::Point> corners{{1, 1, 2.5}, {1, 2, 2.5}, {2.5, 2, 2.5}, {2.5, 1, 2.5}};
    for (auto& c : corners) c -= x;
    const double expected = 0.6 * 10.0 / pi * radiosity::projected_solid_angle(corners, {0, 0, 1});
    const auto found = seen(scene, {3, 3, 1}, x, "surfaces_direct");
    CHECK(std::abs(found.off(expected)) < sigmas);
    CHECK(found.error < 0.01 * expected);
    CHECK(seen(scene, {3, 3, 1}, x, "surfaces_indirect").mean == 0.0);
    // Seen itself.
    CHECK(seen(scene, {3, 3, 1}, {2, 1.5, 2.5}, "emission").mean == Approx(10.0).epsilon(1e-6));
}

TEST_CASE("Path traced: sun, point, spot and sky on a floor") {
    const mesh::Point eye(3, 3, 1), x(1, 2, 0);
    SECTION("parallel sun, slanted") {
        auto scene = test::open_floor(0.5);
        scene.lights = {sun({0.6, 0, -0.8}, 100.0)};
        CHECK(seen(scene, eye, x, "surfaces_direct", 4).mean ==
              Approx(0.5 * 100.0 * 0.8 / pi).epsilon(1e-5));
    }
    SECTION("sun with a diameter of 20 degrees, overhead") {
        auto scene = test::open_floor(0.5);
        scene.lights = {sun({0, 0, -1}, 100.0, 20.0 * pi / 180.0)};
        const auto found = seen(scene, eye, x, "surfaces_direct");
        CHECK(std::abs(found.off(0.5 * 100.0 / pi)) < sigmas);
    }
    SECTION("point light") {
        auto scene = test::floor_room(0.5);
        scene.lights = {{"lamp", radiosity::PointLight{{1, 2, 2}, {7.0}}}};
        CHECK(seen(scene, eye, x, "surfaces_direct", 4).mean ==
              Approx(0.5 * 7.0 / 4.0 / pi).epsilon(1e-4));
    }
    SECTION("spot light's soft edge") {
        auto scene = test::floor_room(0.5);
        const double edge = 0.2;
        // x lies in the middle of the edge: half the intensity.
        const double theta = 0.3 + 0.5 * edge;
        const mesh::Point at(1 + 2 * std::tan(theta), 2, 2);
        scene.lights = {{"spot", radiosity::SpotLight{at, {0, 0, -1}, {7.0}, 0.6, edge}}};
        const double distance = 2.0 / std::cos(theta);
        CHECK(seen(scene, eye, x, "surfaces_direct", 4).mean ==
              Approx(0.5 * 3.5 * std::cos(theta) / (distance * distance) / pi).epsilon(1e-3));
    }
    SECTION("sky") {
        auto scene = test::open_floor(0.5);
        scene.environment = {3.0};
        const auto found = seen(scene, eye, x, "surfaces_indirect");
        CHECK(std::abs(found.off(1.5)) < sigmas);
        CHECK(seen(scene, eye, {3, 3, 2}, "emission", 4).mean == Approx(3.0).epsilon(1e-6));
    }
}

// A slab of medium, 1 m thick, under a sun from above; the ray runs 2 m through it at 0.3 m below
// its top: the angle of scattering is 90°.
TEST_CASE("Path traced: light scattered once has the phase function and the whole extinction") {
    radiosity::Scene scene = test::open_floor(0.0);
    test::add_surfaces(scene, "slab", mesh::box({1, 1, 1}, {3, 3, 2}), {});
    scene.lights = {sun({0, 0, -1}, 100.0)};
    scene.media = {test::medium(1.5, 0.8, mesh::Point(2, 2, 1.5))};
    auto& medium = scene.media[0];
    double phase = 1.0 / (4.0 * pi);
    SECTION("isotropic") {}
    SECTION("Henyey-Greenstein") {
        medium.asymmetry = 0.7;
        phase = (1.0 - 0.49) / (4.0 * pi * std::pow(1.49, 1.5));
    }
    SECTION("Rayleigh") {
        medium.phase = radiosity::PhaseKind::rayleigh;
        phase = 3.0 / (16.0 * pi);
    }
    const double expected = 0.8 * 100.0 * phase * std::exp(-1.5 * 0.3) * -std::expm1(-1.5 * 2.0);
    const auto found = seen(scene, {0.2, 2, 1.7}, {3.5, 2, 1.7}, "single_scattering");
    CHECK(std::abs(found.off(expected)) < sigmas);
    CHECK(found.error < 0.01 * expected);
}

TEST_CASE("Path traced: a point light beside the ray has no spikes") {
    radiosity::Scene scene = test::floor_room(0.0);
    scene.media = {test::medium(0.2, 1.0)};
    scene.lights = {{"lamp", radiosity::PointLight{{2, 2, 1.501}, {1.0}}}};
    // 1 mm beside the ray: the 1/r² of the light is known, and so is its integral along the ray.
    const mesh::Point eye(0.5, 2, 1.5), target(3.5, 2, 1.5);
    double expected = 0.0;
    constexpr int steps = 400000;
    for (int k = 0; k < steps; ++k) {
        // In the angle under which the lamp sees the ray.
        const double a = std::atan2(-1.5, 1e-3), b = std::atan2(2.0, 1e-3);
        const double theta = a + (b - a) * (k + 0.5) / steps;
        const double s = 1e-3 * std::tan(theta), r = 1e-3 / std::cos(theta);
        expected += 0.2 / (4.0 * pi) * std::exp(-0.2 * (1.5 + s + r)) * (b - a) / steps / 1e-3;
    }
    const auto found = seen(scene, eye, target, "single_scattering");
    CHECK(std::abs(found.off(expected)) < sigmas);
    CHECK(found.error < 0.01 * expected);
}

TEST_CASE("Path traced: emission along a ray has no noise, where extinction varies as well") {
    radiosity::Scene scene = test::floor_room(0.0);
    scene.media = {test::medium(1.0, 0.0)};
    scene.media[0].emission = {2.0};
    SECTION("uniform") {
        const auto found = seen(scene, {0.5, 2, 1.5}, {4, 2, 1.5}, "emission", 4);
        CHECK(found.mean == Approx(2.0 * -std::expm1(-3.5)).epsilon(1e-5));
        CHECK(found.error < 1e-5);
    }
    SECTION("linear in x") {
        scene.media[0].shape = {{[](mesh::Point p) { return 0.25 * p.x; }}};
        const auto found = seen(scene, {0.5, 2, 1.5}, {4, 2, 1.5}, "emission", 4);
        CHECK(found.mean == Approx(2.0 * -std::expm1(-0.125 * (16.0 - 0.25))).epsilon(1e-5));
    }
}

TEST_CASE("Path traced: a mirror shows the lamp, times its reflectance") {
    radiosity::Scene scene = test::floor_room(0.0);
    scene.materials[0].specular = {0.6};
    scene.materials.push_back(test::material(0.0, 10.0));
    test::add_surfaces(scene, "lamp", mesh::rectangle({1, 1, 2.5}, {0, 1, 0}, {1, 0, 0}), 2);
    // From (2.5, 1.5, 2.5)'s height to the floor and up to the lamp's middle at (1.5, 1.5).
    const auto image =
        render::path_traced(radiosity::make_enclosure(scene),
                            test::narrow_camera({3.5, 1.5, 2.5}, {2.5, 1.5, 0.0}), {.samples = 64});
    const auto found = test::over(image, "specular_reflection");
    CHECK(found.mean == Approx(6.0).epsilon(1e-5));
    CHECK(found.error < 1e-5);
    CHECK(test::over(image, "surfaces_indirect").mean == 0.0);
    CHECK(test::over(image, "beauty").mean == Approx(6.0).epsilon(1e-5));
}

TEST_CASE("Path traced: in a furnace everything is 1, mirrors and fog with lobes as well") {
    radiosity::Scene scene = test::slit_room();
    scene.materials[0].reflectance = {0.5};
    scene.materials[0].specular = {0.3};
    SECTION("mirrors") {}
    SECTION("gloss") {
        scene.materials[0].roughness = 0.35;
    }
    scene.media[0].asymmetry = 0.6;
    scene.media[0].extinction = {0.6};
    test::add_surfaces(scene, "bank", mesh::box({1.8, 0.3, 0.4}, {2.6, 1.6, 1.3}), {});
    scene.media.push_back(test::medium(2.0, 0.95, mesh::Point(2.2, 1.0, 0.8)));
    scene.media[1].name = "fog";
    scene.media[1].phase = radiosity::PhaseKind::rayleigh;
    auto e = radiosity::make_enclosure(scene);
    test::make_furnace(e);
    auto camera = test::camera_at({0.3, 0.4, 1.0}, {3.0, 1.2, 0.8}, 1.2, 24, 18);
    const auto image = render::path_traced(e, camera, {.samples = 64});
    const auto all = test::over(image, "beauty");
    // The glossy lobe's table loses or gains 2e-3 a reflection, on 2 of them in the mean.
    CHECK(std::abs(all.mean - 1.0) < sigmas * all.error + 1e-3);
    CHECK(all.error < 0.02);
    // Pixels are off by what they say.
    const auto& beauty = image.find("beauty")->values;
    const auto& error = image.find("error")->values;
    double square = 0.0;
    for (std::size_t k = 0; k < beauty.size(); ++k)
        square += std::pow((beauty[k] - 1.0) / error[k], 2);
    CHECK(std::sqrt(square / double(beauty.size())) == Approx(1.0).margin(0.2));
}

TEST_CASE("Path traced: bands at once are the bands one by one") {
    radiosity::Scene both = test::slit_room();
    both.bands = 2;
    for (auto& m : both.materials) {
        m.reflectance = {m.reflectance[0], 0.3 * m.reflectance[0]};
        if (!m.emission.empty()) m.emission = {m.emission[0], 5.0};
    }
    both.media[0].extinction = {0.25, 2.0};
    both.media[0].albedo = {0.9, 0.5};
    radiosity::Scene second = test::slit_room();
    for (auto& m : second.materials) {
        m.reflectance = {0.3 * m.reflectance[0]};
        if (!m.emission.empty()) m.emission = {5.0};
    }
    second.media[0].extinction = {2.0};
    second.media[0].albedo = {0.5};
    const auto camera = test::narrow_camera({0.3, 0.4, 1.0}, {1.4, 1.5, 0.6}, 24);
    const auto two = render::path_traced(radiosity::make_enclosure(both), camera, {.samples = 64});
    const auto& values = two.find("beauty")->values;
    const auto band = [&](std::size_t b) {
        return test::estimate(values.size() / 2, [&](std::size_t k) { return values[2 * k + b]; });
    };
    const auto alone = [&](const radiosity::Scene& scene) {
        return test::over(render::path_traced(radiosity::make_enclosure(scene), camera,
                                              {.samples = 64, .seed = 2}),
                          "beauty");
    };
    for (const auto& [a, b] :
         {std::pair{band(0), alone(test::slit_room())}, std::pair{band(1), alone(second)}}) {
        CHECK(std::abs(a.mean - b.mean) < sigmas * std::hypot(a.error, b.error));
        CHECK(a.error < 0.03 * a.mean);
    }
}

TEST_CASE("Path traced: goals, layers, threads") {
    const auto e = radiosity::make_enclosure(test::slit_room());
    auto camera = test::camera_at({0.3, 0.4, 1.0}, {3.0, 1.2, 0.8}, 1.2, 16, 12);
    const auto image = render::path_traced(e, camera, {.error = 0.03});
    CHECK(image.estimated_block4 <= 0.03);
    CHECK(image.estimated_block4 > 0.015);  // and not much further
    CHECK(image.samples > 16);
    const auto two = render::path_traced(e, camera, {.error = 0.03, .threads = 1});
    for (std::size_t l = 0; l < image.layers.size(); ++l)
        CHECK(image.layers[l].values == two.layers[l].values);
    // The goal is what compare measures against a better picture: 12 blocks tell it to 30 %.
    const auto better = render::path_traced(e, camera, {.error = 0.006, .seed = 9});
    const auto error = render::compare(16, 12, *image.find("beauty"), *better.find("beauty"));
    CHECK(error.block4 == Approx(0.03).margin(0.02));
    // Layers add up.
    for (std::size_t k = 0; k < image.layers[0].values.size(); ++k) {
        double sum = 0.0;
        for (const char* part : {"emission", "surfaces_direct", "surfaces_indirect",
                                 "single_scattering", "multiple_scattering"})
            sum += image.find(part)->values[k];
        CHECK(image.layers[0].values[k] == Approx(sum).epsilon(1e-5).margin(1e-9));
    }
    CHECK(image.find("specular_reflection") == nullptr);
    // A time is kept; the first round is made in any case.
    CHECK(render::path_traced(e, camera, {.time = 1e-3}).samples >= 8);
    // A stop ends it at once, with a picture.
    const auto stopped = render::path_traced(e, camera, {.error = 1e-9},
                                             [](const radiosity::Progress&) { return false; });
    CHECK(stopped.samples == 8);
}

TEST_CASE("Path traced: an eye in a solid is refused") {
    radiosity::Scene scene = test::slit_room();
    test::add_surfaces(scene, "block", mesh::box({0.2, 0.2, 0.0}, {0.6, 0.7, 0.5}), 0);
    const auto e = radiosity::make_enclosure(scene);
    CHECK_THROWS_WITH(render::path_traced(e, test::narrow_camera({0.4, 0.4, 0.2}, {2, 1, 1})),
                      Contains("stands inside a solid"));
}
