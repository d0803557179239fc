// Direct light at a point: the window-shafts room (six openings, one lamp outside, haze inside),
// and the same with the sun, at random points of the room and of its floor. Time a point.
#include <benchmark/benchmark.h>

#include <random>

#include "mesh/shapes.h"
#include "radiosity/direct_light.h"

using namespace tyndall;

namespace {

constexpr std::size_t points_count = 4096;

radiosity::Surface surface(const std::string& name, std::vector<mesh::Polygon> polygons,
                           std::optional<std::size_t> material) {
    return {name, std::move(polygons), material, ""};
}

// The room, its openings, a box on the floor, and a lamp that looks at the windows.
radiosity::Scene window_shafts() {
    radiosity::Scene scene;
    scene.materials.resize(2);
    scene.materials[0].reflectance = {0.5};
    scene.materials[1].reflectance = {0.0};
    scene.materials[1].emission = {2000.0};
    std::vector<mesh::FaceOpening> openings;
    for (const double y : {1.0, 1.75, 2.5})
        for (const double z : {1.0, 1.75}) {
            const std::string name(1, static_cast<char>('u' + openings.size()));
            openings.push_back({"x0", {name, {y, z}, {0.5, 0.5}}});
        }
    for (auto& face : mesh::room({0, 0, 0}, {5, 4, 3}, openings)) {
        const bool opening = face.name.size() == 1;
        scene.surfaces.push_back(surface("room." + face.name, std::move(face.polygons),
                                         opening ? std::nullopt : std::optional<std::size_t>(0)));
    }
    for (auto& face : mesh::box({2, 1.5, 0}, {2.75, 2.25, 0.75}))
        scene.surfaces.push_back(surface("box." + face.name, std::move(face.polygons), 0));
    const mesh::Point corner(-4.126118525018893, 1.8, 4.844777199976747);
    const mesh::Direction u(0, 0.4, 0), v(0.252237050037786, 0, 0.310445600046506);
    for (auto& face : mesh::rectangle(corner, u, v))
        scene.surfaces.push_back(surface("lamp", std::move(face.polygons), 1));
    scene.media.resize(1);
    scene.media[0].extinction = {0.15};
    scene.media[0].albedo = {1.0};
    scene.media[0].at = mesh::Point(2.5, 2, 2);
    scene.viewpoints = {{4.7, 0.3, 1.7}};
    scene.environment = {0.0};
    return scene;
}

struct Points {
    std::vector<mesh::Point> at;
    std::vector<mesh::TetId> tets;

    Points(const mesh::BaseMesh& mesh, double z_low, double z_high) {
        std::mt19937_64 rng(1);
        const auto uniform = [&](double a, double b) {
            return std::uniform_real_distribution<double>(a, b)(rng);
        };
        while (at.size() < points_count) {
            const mesh::Point x(uniform(0, 5), uniform(0, 4), uniform(z_low, z_high));
            if (x.x > 2 && x.x < 2.75 && x.y > 1.5 && x.y < 2.25 && x.z < 0.75) continue;
            at.push_back(x);
            tets.push_back(mesh::locate(mesh, x + mesh::Point(0, 0, 1e-6)));  // above the floor
        }
    }
};

enum Lights { lamp, sun_beam, sun_disc };

void run(benchmark::State& state, bool on_floor) {
    auto scene = window_shafts();
    const mesh::Direction down(0.8, 0.05, -0.6);
    if (state.range(0) != lamp)
        scene.lights = {
            {"sun", radiosity::Sun{down, {800.0}, state.range(0) == sun_disc ? 0.0093 : 0.0}, ""}};
    const auto enclosure = radiosity::make_enclosure(scene);
    const radiosity::DirectLight light(enclosure, {.emitters = state.range(0) == lamp});
    const Points points(enclosure.mesh, on_floor ? 0.0 : 0.01, on_floor ? 0.0 : 2.99);
    double incident = 0.0, lit = 0.0;
    std::size_t k = 0;
    for (auto _ : state) {
        const std::size_t i = k++ % points_count;
        if (on_floor)
            light.at_patch(points.at[i], {0, 0, 1}, points.tets[i], {&incident, 1});
        else
            light.at_zone(points.at[i], points.tets[i], {&incident, 1});
        lit += incident > 0.0;
    }
    state.counters["lit"] = lit / static_cast<double>(k);
}

void zone(benchmark::State& state) {
    run(state, false);
}
void floor(benchmark::State& state) {
    run(state, true);
}

BENCHMARK(zone)->ArgName("light")->Arg(lamp)->Arg(sun_beam)->Arg(sun_disc);
BENCHMARK(floor)->ArgName("light")->Arg(lamp)->Arg(sun_beam)->Arg(sun_disc);

}  // namespace

BENCHMARK_MAIN();
