// The line of sight: packed zones, pixels of one ray, and indirect light gathered where it is seen.
#include "render/line_of_sight.h"

#include "radiosity/adaptive.h"
#include "radiosity/probe.h"
#include "render/compare.h"
#include "render/seen_solution.h"
#include "render/sight_zones.h"
#include "support/catch.h"
#include "support/path_scenes.h"

using namespace tyndall;

namespace {

// A room of 3 × 2 × 2 m in thin fog, a lamp in the ceiling, a block that hovers 10 cm above the
// floor.
radiosity::Scene room_with_block(double extinction) {
    radiosity::Scene scene;
    scene.materials = {test::material(0.6), test::material(0.0, 10.0)};
    test::add_surfaces(scene, "room", mesh::room({0, 0, 0}, {3, 2, 2}), 0);
    test::add_surfaces(scene, "lamp", mesh::rectangle({0.5, 0.7, 2}, {0, 0.6, 0}, {0.6, 0, 0}), 1);
    test::add_surfaces(scene, "block", mesh::box({1.6, 0.6, 0.1}, {2.4, 1.4, 0.7}), 0);
    scene.media = {test::medium(extinction, 0.9)};
    return scene;
}

// On the base mesh, whose patches are as large as the walls.
radiosity::Solution coarse_solution(double extinction) {
    return radiosity::solve_adaptively(test::enclosed(room_with_block(extinction)),
                                       {.start = radiosity::Start::base,
                                        .refinement = radiosity::Refinement::none,
                                        .rays = 256,
                                        .gather_rays = 256});
}

render::Camera view_of_block() {
    return test::camera_at({0.2, 0.3, 1.0}, {2.0, 1.0, 0.4}, 1.2, 64, 48);
}

}  // namespace

TEST_CASE("Zones packed for sight show what the forest holds", "[line_of_sight][long]") {
    auto scene = room_with_block(0.4);
    for (auto& material : scene.materials)
        for (auto* values : {&material.reflectance, &material.emission})
            if (!values->empty()) values->resize(3, values->front());
    scene.media[0].extinction = {0.2, 0.4, 0.4};
    scene.media[0].albedo = {0.9, 0.8, 0.7};
    scene.bands = 3;
    const auto radiance = GENERATE(radiosity::Radiance::linear, radiosity::Radiance::quadratic);
    const auto s = radiosity::solve_adaptively(
        test::enclosed(scene),
        {.error = 0.1, .radiance = radiance, .max_elements = 4000, .rays = 16, .gather_rays = 16});
    const render::SightZones packed(s);
    const render::SeenSolution exact(s, 0.0);
    const auto& mesh = s.enclosure->mesh;
    render::Seen a, b;
    double worst = 0.0, mean = 0.0;
    std::size_t crossed = 0;
    for (int k = 0; k < 400; ++k) {
        const double u = (k + 0.5) / 400.0, v = std::fmod(0.618034 * k, 1.0);
        const mesh::Ray ray{{0.2, 0.3, 1.0}, radiosity::uniform_direction(u, v)};
        const render::SightRay sight(ray);
        a.clear(3);
        b.clear(3);
        mesh::walk(mesh, ray, {mesh::locate(mesh, ray.origin)},
                   [&](mesh::TetId tet, double in, double out) {
                       ++crossed;
                       packed.cross(sight, tet, in, out, a);
                       mesh::descend(s.forest, mesh::root_zone(tet), ray, in, out, mesh::at_leaves,
                                     [&](mesh::ZoneId zone, double t_in, double t_out) {
                                         exact.cross(ray, zone, t_in, t_out, b);
                                         return true;
                                     });
                       return true;
                   });
        for (std::size_t i = 0; i < a.radiance.size(); ++i) {
            worst = std::max(worst, std::abs(a.radiance[i] - b.radiance[i]));
            mean += b.radiance[i] / 400.0;
        }
        for (std::size_t i = 0; i < 3; ++i)
            CHECK(a.transmittance[i] == Approx(b.transmittance[i]).epsilon(1e-5));
    }
    CHECK(crossed > 1000);
    CHECK(mean > 0.0);
    CHECK(worst < 1e-5 * mean);  // single precision
}

TEST_CASE("Pixels of one ray look like those of many", "[line_of_sight][long]") {
    const auto s = radiosity::solve_adaptively(
        test::enclosed(room_with_block(0.2)),
        {.error = 0.1, .max_elements = 4000, .rays = 16, .gather_rays = 16},
        view_of_block().view());
    const auto camera = view_of_block();
    const auto few = render::line_of_sight(s, camera, {.samples = 64, .contrast = 0.01});
    const auto all = render::line_of_sight(s, camera, {.samples = 64, .contrast = 0.0});
    const auto &p = few.find("beauty")->values, &q = all.find("beauty")->values;
    std::size_t same = 0;
    double worst = 0.0;
    for (std::size_t k = 0; k < p.size(); ++k) {
        same += p[k] == q[k];
        worst = std::max<double>(worst, std::abs(p[k] - q[k]) / q[k]);
    }
    // At edges all rays are taken, and they are the same; elsewhere the middle is the mean, nearly.
    CHECK(same > p.size() / 10);
    CHECK(same < p.size() * 2 / 3);
    CHECK(worst < 0.03);  // an edge may hide between the middles
    // A tenth of what a pixel of one ray may depart from linear by.
    CHECK(render::block_error(64, 48, *few.find("beauty"), *all.find("beauty"), 1) < 0.001);
    // Parts of the picture are the whole's, but for the places of the 64 rays at edges.
    const auto part = render::line_of_sight(s, camera.cropped(16, 8, 20, 24), {.samples = 64});
    const auto cut = render::region_of(64, 48, *few.find("beauty"), {16, 8, 20, 24});
    CHECK(render::block_error(20, 24, *part.find("beauty"), cut, 1) < 0.005);
    const auto again = render::line_of_sight(s, camera, {.samples = 64, .threads = 1});
    CHECK(again.find("beauty")->values == p);
}

TEST_CASE("A final gather is right where the mesh is too coarse", "[line_of_sight]") {
    const auto s = coarse_solution(0.1);
    const radiosity::Probe probe(s, {.rays = 16384});
    // On the floor under the block's edge, beside it and far from it; on the block's dark side.
    const std::pair<mesh::Point, mesh::Direction> places[]{
        {{1.65, 0.9, 0.0}, {0, 0, 1}}, {{1.4, 0.9, 0.0}, {0, 0, 1}},  {{0.4, 1.6, 0.0}, {0, 0, 1}},
        {{2.4, 1.1, 0.3}, {1, 0, 0}},  {{3.0, 1.0, 0.2}, {-1, 0, 0}}, {{2.0, 0.6, 0.5}, {0, -1, 0}},
    };
    double departure = 0.0;
    for (const auto& [x, normal] : places) {
        CAPTURE(x.x, x.y, x.z);
        const auto e = probe.on_surface(x, normal);
        const double expected = 0.6 * (e.irradiance[0] - e.irradiance_direct[0]) / M_PI;
        const auto camera = test::narrow_camera(x + 0.05 * normal, x, 4);
        const auto seen = [&](std::size_t rays) {
            const auto image =
                render::line_of_sight(s, camera, {.samples = 1, .final_gather = rays});
            return test::over(image, "surfaces_indirect").mean /
                   test::over(image, "transmittance").mean;
        };
        // Of 4096 rays, and zones that stand for those in them: a percent.
        CHECK(seen(4096) == Approx(expected).epsilon(0.02));
        departure = std::max(departure, std::abs(seen(0) / expected - 1.0));
    }
    CHECK(departure > 0.1);  // of what the patches hold
}
