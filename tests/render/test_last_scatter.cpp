// The last scattering towards the eye, against closed forms, sums over directions, line_of_sight.
#include "render/last_scatter.h"

#include <numbers>

#include "radiosity/adaptive.h"
#include "radiosity/closed_forms.h"
#include "radiosity/probe.h"
#include "render/arriving_light.h"
#include "render/line_of_sight.h"
#include "render/path_traced.h"
#include "render/random_numbers.h"
#include "render/two_pass.h"
#include "support/catch.h"
#include "support/path_scenes.h"

using namespace tyndall;
using std::numbers::pi;

namespace {

radiosity::Solution solved_roughly(const radiosity::Scene& scene) {
    return radiosity::solve_adaptively(test::enclosed(scene),
                                       {.error = 0.1,
                                        .refinement = radiosity::Refinement::adaptive,
                                        .max_elements = 1500,
                                        .rays = 64,
                                        .gather_rays = 64});
}

radiosity::Scene foggy_slit(double asymmetry, double extinction = 0.5) {
    auto scene = test::slit_room();
    scene.media[0].asymmetry = asymmetry;
    scene.media[0].extinction = {extinction};
    return scene;
}

mesh::Direction anywhere(render::RandomNumbers& random) {
    const double u = random();
    return radiosity::uniform_direction(u, random());
}

}  // namespace

TEST_CASE("Spherical harmonics add up to Legendre polynomials") {
    constexpr std::size_t order = 9;
    render::RandomNumbers random(1, 0);
    std::vector<double> at_u(render::harmonics_count(order)), at_v(at_u.size());
    for (int k = 0; k < 20; ++k) {
        const auto u = k == 0 ? mesh::Direction(0, 0, -1) : anywhere(random), v = anywhere(random);
        render::spherical_harmonics(u, order, at_u);
        render::spherical_harmonics(v, order, at_v);
        for (std::size_t l = 0; l <= order; ++l) {
            double sum = 0.0;
            for (std::size_t n = l * l; n < (l + 1) * (l + 1); ++n) sum += at_u[n] * at_v[n];
            const double expected =
                (2.0 * double(l) + 1.0) / (4.0 * pi) * std::legendre(unsigned(l), glm::dot(u, v));
            CHECK(sum == Approx(expected).margin(1e-12));  // rounding
        }
    }
}

TEST_CASE("Phase functions are their Legendre series") {
    for (const auto& phase :
         {radiosity::PhaseFunction{.asymmetry = 0.6}, radiosity::PhaseFunction{.asymmetry = -0.3},
          radiosity::PhaseFunction{.kind = radiosity::PhaseKind::rayleigh}})
        for (const double cosine : {-1.0, -0.3, 0.5, 1.0}) {
            double sum = 0.0;
            for (unsigned l = 0; l < 80; ++l)  // 0.6^80 is nothing
                sum += (2.0 * l + 1.0) / (4.0 * pi) * render::phase_coefficient(phase, l) *
                       std::legendre(l, cosine);
            CHECK(sum == Approx(radiosity::phase_value(phase, cosine)).epsilon(1e-10));
        }
}

TEST_CASE("Cubes: the mean of what arrives is the isotropic gather's", "[long]") {
    const auto solution = solved_roughly(foggy_slit(0.7));
    const render::ArrivingLight light(solution, {.brightest = 0.0, .sweeps = 0});
    const radiosity::Probe probe(solution, {.rays = 4096});
    double square = 0.0, sum = 0.0;
    std::size_t count = 0;
    REQUIRE(light.cube_count() > 30);
    for (std::size_t k = 0; k < light.cube_count(); k += light.cube_count() / 30, ++count) {
        const auto values = probe.in_space(light.place(k));
        const double expected = (values.incident[0] - values.incident_direct[0]) / (4.0 * pi);
        square += std::pow(light.mean(k)[0] - expected, 2);
        sum += expected;
    }
    const double n = double(count);
    const double off = std::sqrt(square / n) / (sum / n);
    INFO(off);
    // A pixel of a cube of 16 is a 1536th of all directions, and what is lit brightly by the slit
    // is a few of them wide: they are hit or not.
    CHECK(off < 0.02);
}

TEST_CASE("Cubes: the series is the sum of Φ over the cube's pixels", "[long]") {
    const auto scene = foggy_slit(0.6);
    const auto solution = solved_roughly(scene);
    // Base tetrahedra: as many cubes as the test looks at, not many more.
    const render::ArrivingPlacesOptions coarse{
        .patch_group = 1.0, .lit_patch_group = 1.0, .least = 1.0};
    const render::ArrivingLight light(
        solution,
        {.resolution = 32, .brightest = 0.0, .places = coarse, .series = 1e-3, .sweeps = 0});
    const radiosity::GatherScene gathered(*solution.enclosure, solution.forest,
                                          radiosity::reflected_sources(solution), 0.2);
    const radiosity::PhaseFunction phase{.asymmetry = 0.6};
    render::RandomNumbers random(2, 0);
    std::vector<double> weights;
    std::size_t looked = 0;
    for (std::size_t z = 0; z < solution.forest.zone_count() && looked < 6; z += 7) {
        const mesh::ZoneId zone(z);
        if (!light.group(zone)) continue;
        ++looked;
        // In the middle, as the mean of the corners' sums.
        const auto x = solution.forest.centroid(zone);
        const auto direction = anywhere(random);
        double turned = 0.0, mean = 0.0;
        for (const auto corner : solution.forest[zone].corners) {
            const auto at =
                solution.forest.point(corner) + 1e-3 * (x - solution.forest.point(corner));
            for (const auto& face : radiosity::full_cube_faces(48))
                for (std::size_t j = 0; j < face.nv; ++j)
                    for (std::size_t i = 0; i < face.nu; ++i) {
                        const auto u = glm::normalize(face.direction(i, j));
                        double radiance = 0.0;
                        radiosity::radiance_along(gathered, {at, u},
                                                  {solution.forest.base_tet(zone)}, {&radiance, 1});
                        const double share = face.weights[j * face.nu + i] * radiance;
                        mean += share;
                        turned += share * 4.0 * pi *
                                  radiosity::phase_value(phase, glm::dot(u, direction));
                    }
        }
        light.weigh(0, direction, weights);
        double q = 0.0, again = 0.0;
        light.shares(zone, weights, x, x, {&q, 1}, {&again, 1});
        CHECK(again == q);
        INFO(q << " for " << turned / mean);
        // What the two cubes' pixels may miss differently of what is small and bright.
        CHECK(q == Approx(turned / mean).epsilon(0.02));
    }
    CHECK(looked == 6);
}

// As the path tracer's: a slab of 1 m under a sun, crossed 0.3 m below its top.
TEST_CASE("Last scatter: light scattered once has the phase function and the whole extinction",
          "[long]") {
    radiosity::Scene scene = test::open_floor(0.0);
    test::add_surfaces(scene, "slab", mesh::box({1, 1, 1}, {3, 3, 2}), {});
    double angle = 0.0;
    SECTION("parallel sun") {}
    SECTION("sun with a diameter") {
        angle = 10.0 * pi / 180.0;
    }
    scene.lights = {{"sun", radiosity::Sun{{0, 0, -1}, {100.0}, angle}}};
    scene.media = {test::medium(1.5, 0.8, mesh::Point(2, 2, 1.5))};
    scene.media[0].asymmetry = 0.7;
    const auto solution = solved_roughly(scene);
    const auto image = render::last_scatter(
        solution, test::narrow_camera({0.2, 2, 1.7}, {3.5, 2, 1.7}), {.samples = 64});
    const double phase = (1.0 - 0.49) / (4.0 * pi * std::pow(1.49, 1.5));
    const double expected = 0.8 * 100.0 * phase * std::exp(-1.5 * 0.3) * -std::expm1(-1.5 * 2.0);
    const auto found = test::over(image, "single_scattering");
    if (angle == 0.0) {
        // What leaves hold is in closed form, what they leave out is drawn.
        CHECK(std::abs(found.off(expected)) < 4.5);
        CHECK(found.error < 1e-3 * expected);  // 3e-4 measured with 64 samples
    } else {
        // Φ and the slanted way vary over the disc; paths know.
        const auto paths =
            test::over(render::path_traced(*solution.enclosure,
                                           test::narrow_camera({0.2, 2, 1.7}, {3.5, 2, 1.7}),
                                           {.samples = 256}),
                       "single_scattering");
        CHECK(std::abs(paths.off(found.mean)) < 4.5);
        CHECK(paths.error < 0.003 * expected);
    }
    CHECK(test::over(image, "transmittance").mean == Approx(std::exp(-1.5 * 2.0)).epsilon(1e-5));
}

TEST_CASE("Last scatter: where media scatter evenly it is line_of_sight's picture", "[long]") {
    const auto camera = test::narrow_camera({0.3, 0.4, 1.0}, {3.0, 1.2, 0.8});
    // With cubes (an asymmetry of 1e-9 asks for them) and without.
    const double asymmetry = GENERATE(0.0, 1e-9);
    const auto solution = solved_roughly(foggy_slit(asymmetry));
    const auto line = render::line_of_sight(solution, camera, {.samples = 8});
    const auto last = render::last_scatter(solution, camera, {.samples = 8});
    for (const char* layer : {"emission", "surfaces_direct", "surfaces_indirect",
                              "multiple_scattering", "transmittance", "depth"}) {
        INFO(layer);
        // Rays within a thousandth of a degree, floats, and q = 1 to 1e-9.
        CHECK(test::over(last, layer).mean == Approx(test::over(line, layer).mean).epsilon(1e-4));
    }
}

// Both are L³ of (60); the one by cubes and closed forms, the other by paths that are handed over
// to the solution at their third scattering.
TEST_CASE("Last scatter is what two_pass finds by three scatterings", "[long]") {
    const auto solution = solved_roughly(foggy_slit(0.7));
    render::Camera camera = test::narrow_camera({0.3, 0.4, 1.0}, {3.0, 1.2, 0.8});
    camera.fov_x = 1.0;
    const auto last = render::last_scatter(solution, camera, {.samples = 16});
    const auto two = render::two_pass(solution, camera, {.samples = 512, .scatterings = 3});
    const auto scattered = [](const render::Image& image) {
        return test::over(image, "single_scattering").mean +
               test::over(image, "multiple_scattering").mean;
    };
    // Cubes are made by whichever thread comes first, and are the same.
    const auto one = render::last_scatter(solution, camera, {.samples = 16, .threads = 1});
    CHECK(one.find("beauty")->values == last.find("beauty")->values);
    double noise = 0.0;
    for (const auto* image : {&last, &two})
        for (const float e : image->find("error")->values) noise += double(e) * double(e);
    noise = std::sqrt(noise) / double(camera.width * camera.height);
    const double mean = scattered(two);
    // Cubes are 16 pixels wide, and linear between their places: 0.5 %.
    INFO(scattered(last) / mean << " with noise of " << noise / mean);
    CHECK(std::abs(scattered(last) - mean) < std::hypot(4.5 * noise, 0.005 * mean));
    CHECK(noise < 0.01 * mean);
}
