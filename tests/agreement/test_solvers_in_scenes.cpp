// Every solver finds the same coarse solution in every example scene.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "cli/scene_file.h"
#include "mesh/forest.h"
#include "mesh/shapes.h"
#include "radiosity/adaptive.h"
#include "radiosity/coarse_solution.h"
#include "radiosity/point_set.h"
#include "radiosity/scene_builder.h"
#include "radiosity/solvers.h"
#include "radiosity/start_elements.h"
#include "support/catch.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

std::vector<std::filesystem::path> scene_files() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry :
         std::filesystem::directory_iterator(TYNDALL_SOURCE_DIR "/examples/scenes"))
        if (entry.path().extension() == ".toml") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

// Direct light of no scene in particular: what is tested is the linear system, and this has light
// in every corner of it.
std::vector<double> some_light(const Elements& elements) {
    std::vector<double> light(elements.size() * elements.bands);
    for (std::size_t k = 0; k < light.size(); ++k)
        light[k] = 0x1p-53 * static_cast<double>(hash_seed(7, k) >> 11);
    return light;
}

struct Solved {
    std::vector<double> reflected, indirect;
    SolverReport report;
    double reciprocity_error;
};

Solved solved(const Enclosure& enclosure, const Forest& forest, const SolveOptions& options) {
    // On the base mesh; where that is large (columns with 8600 elements) on one zone a medium.
    constexpr std::size_t most = 3000;
    Elements elements = elements_of_leaves(enclosure, forest);
    if (elements.size() > most) elements = start_elements(enclosure, forest, Start::single_zone);
    CoarseSolution coarse(enclosure, forest, std::move(elements), options, {});
    coarse.solve(some_light(coarse.elements()));
    Solved result{{}, {}, coarse.report(), coarse.reciprocity_error(0)};
    const Elements& e = coarse.elements();
    for (std::size_t i = 0; i < e.size(); ++i)
        for (std::size_t b = 0; b < e.bands; ++b) {
            result.reflected.push_back(e.capacity[i * e.bands + b] * coarse.reflected(i, b));
            result.indirect.push_back(e.capacity[i * e.bands + b] * coarse.indirect(i, b));
        }
    return result;
}

// Σ |a − b| / Σ b of powers.
double difference(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0.0, whole = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        REQUIRE(std::isfinite(a[k]));
        sum += std::abs(a[k] - b[k]);
        whole += b[k];
    }
    return sum / whole;
}

}  // namespace

TEST_CASE("All solvers agree in every example scene", "[solvers][long]") {
    const auto path = GENERATE(from_range(scene_files()));
    const auto file = cli::read_scene_file(path);
    const Enclosure enclosure = make_enclosure(file.scene);
    const Forest forest(enclosure.mesh);  // the base mesh
    for (const Radiance radiance : {Radiance::constant, Radiance::linear}) {
        SolveOptions options{.radiance = radiance, .rays = 16};
        options.solver_tolerance = radiance == Radiance::linear ? 1e-6 : 1e-9;
        options.solver_iterations = 10'000;
        options.solver = "direct";
        const Solved exact = solved(enclosure, forest, options);
        REQUIRE(exact.report.converged);
        for (const auto& named : solvers()) {
            options.solver = named.name;
            const Solved one = solved(enclosure, forest, options);
            CAPTURE(path, named.name, one.report.iterations, one.report.residual);
            CHECK(one.report.converged);
            CHECK(one.report.method == named.name);
            // Nothing in these scenes keeps more than 97 % of its light: a residual means at most
            // 30 times itself in the solution.
            CHECK(difference(one.reflected, exact.reflected) < 30.0 * options.solver_tolerance);
            CHECK(difference(one.indirect, exact.indirect) < 30.0 * options.solver_tolerance);
        }
    }
}

TEST_CASE("Shots on the fly agree within what rows are reciprocal to, in every example scene",
          "[solvers][long]") {
    const auto path = GENERATE(from_range(scene_files()));
    const auto file = cli::read_scene_file(path);
    const Enclosure enclosure = make_enclosure(file.scene);
    const Forest forest(enclosure.mesh);
    SolveOptions options{.radiance = Radiance::constant, .rays = 64};
    const Solved kept = solved(enclosure, forest, options);
    options.solver = "progressive_refinement";
    options.shots = Shots::on_the_fly;
    options.solver_tolerance = 1e-2;
    const Solved shot = solved(enclosure, forest, options);
    CAPTURE(path, kept.reciprocity_error, shot.report.shots);
    CHECK(shot.report.converged);
    CHECK(std::isnan(shot.reciprocity_error));
    // The tolerance's 1 % may be a few in the solution. What S_ij and S_ji differ by enters once
    // for every bounce, and has either sign: in the mean it is less than once in all.
    CHECK(difference(shot.indirect, kept.indirect) < kept.reciprocity_error + 0.03);
}

TEST_CASE("Where nothing absorbs a source is refused, and without one all is dark", "[solvers]") {
    const auto room = [](double emission) {
        Scene scene;
        add_surface(scene, "room", mesh::room({0, 0, 0}, {2, 2, 2}),
                    {.reflectance = {1.0}, .emission = {emission}});
        scene.media = {{.name = "fog", .extinction = {0.5}, .albedo = {1.0}}};
        return scene;
    };
    CHECK_THROWS_WITH(make_enclosure(room(1.0)), Contains("grows for ever"));
    const auto dark = std::make_shared<const Enclosure>(make_enclosure(room(0.0)));
    for (const auto& named : solvers()) {
        CAPTURE(named.name);
        const Solution solution = solve_adaptively(dark, {.solver = std::string(named.name),
                                                          .refinement = Refinement::none,
                                                          .rays = 16,
                                                          .gather_rays = 4});
        CHECK(solution.report.solver.converged);
        CHECK(solution.report.solver.iterations == 0);
        CHECK(solution.report.energy_balance == 0.0);
        for (const double x : solution.coarse.radiance) CHECK(x == 0.0);
        for (const double h : solution.coarse.incident) CHECK(h == 0.0);
    }
}
