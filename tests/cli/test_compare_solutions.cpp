// Solutions compared with each other, in the library and by the command.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "cli/compare_solutions.h"
#include "cli/scene_file.h"
#include "radiosity/adaptive.h"
#include "render/mesh_pictures.h"
#include "support/catch.h"
#include "support/program.h"

using namespace tyndall;
namespace fs = std::filesystem;

namespace {

// Half of the room is empty, half of it haze.
constexpr const char* half_hazy_scene = R"(format = 1
material = [ { name = "grey", reflectance = 0.5 },
             { name = "lamp", reflectance = 0.0, emission = 100.0 } ]
surface  = [ { name = "room", material = "grey", room = { min = [0, 0, 0], max = [2, 1, 1] } },
             { name = "face", rectangle = { corner = [1, 0, 0], u = [0, 1, 0], v = [0, 0, 1] } },
             { name = "lamp", material = "lamp", rectangle = { corner = [0.3, 0.3, 1], u = [0, 0.3, 0], v = [0.3, 0, 0] } } ]
medium   = [ { name = "haze", extinction = 0.5, albedo = 0.8, at = [0.5, 0.5, 0.5] } ]
camera   = [ { name = "main", eye = [0.9, 0.1, 0.5], target = [0.3, 0.6, 0.4], fov_y = 60, width = 16, height = 12 } ]
)";

struct Folder : test::Workplace {
    Folder() : test::Workplace("solutions") { write("scene.toml", half_hazy_scene); }
};

radiosity::Solution solved(const Folder& folder, double size, double emission = 100.0) {
    const auto file = cli::read_scene_file(
        folder.path / "scene.toml",
        {"solve.element_size=" + std::to_string(size), "solve.refinement=uniform", "solve.rays=64",
         "solve.gather_rays=64", "material.lamp.emission=" + std::to_string(emission)});
    return radiosity::solve_adaptively(
        std::make_shared<const radiosity::Enclosure>(radiosity::make_enclosure(file.scene)),
        file.solve);
}

}  // namespace

TEST_CASE("Points lie in the media and on sides, evenly by what holds light") {
    const Folder folder;
    const auto file = cli::read_scene_file(folder.path / "scene.toml");
    const auto enclosure = radiosity::make_enclosure(file.scene);
    const auto points = cli::sample_points(enclosure, 512);
    REQUIRE(points.size() == 1024);
    double mean_x = 0.0;
    std::size_t floor = 0;
    for (std::size_t k = 0; k < 512; ++k) {
        CHECK_FALSE(points[k].on_side());
        CHECK(points[k].x.x <= 1.0 + 1e-12);  // the haze's half
        mean_x += points[k].x.x / 512.0;
    }
    for (std::size_t k = 512; k < 1024; ++k) {
        CHECK(points[k].on_side());
        floor += points[k].normal.z > 0.5;
    }
    // 512 quasi-random points: the mean to 0.02, the floor's fifth of the area to 0.02.
    CHECK(mean_x == Approx(0.5).margin(0.02));
    CHECK(static_cast<double>(floor) / 512.0 == Approx(0.2).margin(0.02));
}

TEST_CASE("A solution is no way off from itself, and by a tenth from one a tenth brighter") {
    const Folder folder;
    const auto solution = solved(folder, 0.6), brighter = solved(folder, 0.6, 110.0);
    const cli::SolutionComparison options{64, 64};
    const auto same = cli::compare_solutions(solution, solution, options);
    CHECK(same.source->rmse == 0.0);
    CHECK(same.irradiance->bias == 0.0);
    const auto errors = cli::compare_solutions(brighter, solution, options);
    CHECK(errors.source->points == 64);
    // Light is linear: every value is 1.1 times the other's, to rounding and the solver's 1e-6.
    CHECK(errors.source->bias == Approx(0.1).epsilon(1e-4));
    CHECK(errors.irradiance->bias == Approx(0.1).epsilon(1e-4));
    CHECK(errors.source->rmse >= errors.source->bias);
}

TEST_CASE("What the leaves hold comes nearer to the probes as the mesh gets finer", "[long]") {
    const Folder folder;
    const auto fine = solved(folder, 0.2), coarse = solved(folder, 0.9);
    const cli::SolutionComparison options{128, 256};
    const auto far = cli::compare_solutions(coarse, fine, options);
    const auto near = cli::compare_solutions(fine, fine, options);
    CHECK(near.source_held->rmse < 0.5 * far.source_held->rmse);
    CHECK(near.irradiance_held->rmse < 0.5 * far.irradiance_held->rmse);
    // Probes compute direct light anew: they depend on the mesh far less than what it holds.
    CHECK(far.source->rmse < 0.2 * far.source_held->rmse);
}

TEST_CASE("Pictures of a mesh show its edges") {
    const Folder folder;
    const auto solution = solved(folder, 0.6);
    const auto slice = render::field_slice(solution, {{0, 0.5, 0.5}, {0, 1, 0}}).image;
    CHECK(slice.width == 960);  // along the haze, 1 m × 1 m
    CHECK(slice.height == 960);
    std::set<std::array<std::uint8_t, 3>> colours;
    for (std::size_t k = 0; k < slice.values.size(); k += 3)
        colours.insert({slice.values[k], slice.values[k + 1], slice.values[k + 2]});
    CHECK(colours.size() > 100);
    const auto file = cli::read_scene_file(folder.path / "scene.toml");
    const render::DisplayImage grey{16, 12, 1, std::vector<std::uint8_t>(16 * 12, 128)};
    const auto overlay = render::mesh_overlay(solution, file.cameras[0], grey);
    CHECK(overlay.width == 640);
    CHECK(overlay.height == 480);
    std::size_t edges = 0;
    for (std::size_t k = 0; k < overlay.values.size(); k += 3) edges += overlay.values[k] != 128;
    // Patches half a metre wide, seen from half a metre: lines on some percent of the pixels.
    CHECK(edges > 640 * 480 / 200);
    CHECK(edges < 640 * 480 / 10);
}

TEST_CASE("compare takes solutions where there is no picture, and where it is told to") {
    const Folder folder;
    const auto run = [&](const std::string& arguments) { return folder.run(arguments).code; };
    const auto said = [&](const char* name) { return folder.read(name); };
    const std::string set =
        " --quiet --set solve.rays=16 --set solve.gather_rays=16 --set "
        "solve.error=0.3 --set solve.element_size=";
    REQUIRE(run("run scene.toml -o a" + set + "0.9") == 0);
    REQUIRE(run("solve scene.toml -o b" + set + "0.6") == 0);
    CHECK(run("compare a b --points 16 --rays 64 --json") == 0);
    const auto json = nlohmann::json::parse(said("out.txt"));
    CHECK(json.at("source").at("points") == 16);
    CHECK(json.at("irradiance_held").at("rmse").get<double>() > 0.0);
    CHECK(run("compare a/solution.vtkhdf a --points 16 --rays 64 --max-rmse 0") == 0);
    CHECK_THAT(said("out.txt"), Contains("J probed") && Contains("E held"));
    CHECK(run("compare a a") == 0);  // pictures
    CHECK_THAT(said("out.txt"), Contains("4x4 blocks"));
    CHECK(run("compare a a --solutions --points 16 --rays 64") == 0);
    CHECK_THAT(said("out.txt"), Contains("J probed"));
    CHECK(run("compare a b --points 16 --rays 64 --max-rmse 1e-9") == 1);
    CHECK_THAT(said("err.txt"), Contains("rmse of J"));
    CHECK(run("compare a b --layer emission") == 1);
    CHECK_THAT(said("err.txt"), Contains("speak of pictures"));
}
