// Solvers as users ask for them: by name, with their settings, in reports and studies.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "support/catch.h"
#include "support/foggy_box.h"
#include "support/program.h"

using namespace tyndall;

namespace {

struct SolverWorkplace : test::Workplace {
    SolverWorkplace() : test::Workplace("solvers") { write("box.toml", test::foggy_box); }

    nlohmann::json solved(const std::string& settings) const {
        return nlohmann::json::parse(
            good("solve box.toml -o out --json --set solve.refinement=none " + settings));
    }
};

}  // namespace

TEST_CASE("Every solver gives one report", "[long]") {
    const SolverWorkplace place;
    const auto reference = place.solved("");
    CHECK(reference.at("solver").at("method") == "gmres");
    for (const auto& [name, method] : {std::pair{"krylov", "gmres"},
                                       {"gathering", "gauss_seidel"},
                                       {"jacobi", "jacobi"},
                                       {"bicgstab", "bicgstab"},
                                       {"progressive_refinement", "progressive_refinement"},
                                       {"direct", "direct"}}) {
        CAPTURE(name);
        const auto report = place.solved("--set solve.solver=" + std::string(name));
        const auto& solver = report.at("solver");
        CHECK(solver.at("method") == method);
        CHECK(solver.at("converged") == true);
        const auto& history = solver.at("history");
        REQUIRE(history.size() >= 2);
        CHECK(history.front().at("residual") == Approx(1.0));
        CHECK(history.back().at("residual").get<double>() <= 1e-6);
        CHECK(history.back().at("iterations") == solver.at("iterations"));
        CHECK(history.back().at("cpu_seconds").get<double>() >= 0.0);
        // The last of power is where its shots, or its passes, left it; in units of what came in.
        CHECK(history.back().at("unshot_power").get<double>() <
              1e-5 * history.front().at("unshot_power").get<double>());
        for (const auto& [side, power] : report.at("net_power").items())
            CHECK(power.get<double>() ==
                  Approx(reference.at("net_power").at(side).get<double>()).epsilon(1e-4));
    }
}

TEST_CASE("Shots on the fly: no rows, the same light") {
    const SolverWorkplace place;
    const auto kept = place.solved("--set solve.radiance=constant --set solve.rays=64");
    const auto fly = place.solved(
        "--set solve.rays=64 --set solve.solver=progressive_refinement "
        "--set solve.shots=on_the_fly --set solve.solver_tolerance=1e-3");
    CHECK(fly.at("solver").at("converged") == true);
    CHECK(fly.at("solver").at("shots").get<int>() > 100);
    CHECK(fly.at("reciprocity_error").is_null());
    CHECK(fly.at("closure_error").get<double>() < 1e-9);
    // Every shot keeps its power: what is missing is unshot, 1e-3 of the sources.
    CHECK(std::abs(fly.at("energy_balance").get<double>()) < 3e-3);
    const auto rays = [](const nlohmann::json& report) {
        std::size_t sum = 0;
        for (const auto& pass : report.at("passes")) sum += pass.at("rays").get<std::size_t>();
        return sum;
    };
    CHECK(rays(fly) > rays(kept));
    // Rows of 64 rays differ from their columns by some per cent.
    for (const char* name : {"fog", "room.floor+", "room.x0+"})
        CHECK(fly.at("net_power").at(name).get<double>() ==
              Approx(kept.at("net_power").at(name).get<double>()).epsilon(0.05));
}

TEST_CASE("A solver that ends too early says so in the report") {
    const SolverWorkplace place;
    const auto report = place.solved("--set solve.solver=jacobi --set solve.solver_iterations=2");
    CHECK(report.at("solver").at("converged") == false);
    CHECK(report.at("solver").at("iterations") == 2);
    CHECK(report.at("solver").at("unshot_power").get<double>() > 0.1);
    const auto warnings = report.at("warnings").get<std::vector<std::string>>();
    CHECK(std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
        return warning.find("the solver (jacobi) did not converge") != warning.npos &&
               warning.find("solve.solver_iterations") != warning.npos;
    }));
}

TEST_CASE("The direct solver refuses what it would take gigabytes for, before any row is made") {
    const SolverWorkplace place;
    const auto outcome = place.run(
        "solve box.toml -o out --set solve.solver=direct --set solve.element_size=0.2 "
        "--set solve.max_elements=1000000 --set solve.rays=100000");
    CHECK(outcome.code == 1);
    CHECK_THAT(outcome.err, Contains("for up to 6000 elements") && Contains("\"gmres\""));
}

TEST_CASE("A study of solvers draws their histories", "[long]") {
    const SolverWorkplace place;
    place.write("study.toml", R"(scene = "box.toml"
reference = { "solve.solver" = "direct" }
[set]
"solve.refinement" = "none"
[axes]
"solve.solver" = ["gmres", "progressive_refinement"]
)");
    place.good("study study.toml -o out");
    for (const char* plot : {"solver_residual_iterations", "solver_residual_cpu",
                             "solver_unshot_cpu", "solver_balance_cpu"}) {
        CAPTURE(plot);
        const auto svg = place.read("out/plots/" + std::string(plot) + ".svg");
        CHECK_THAT(svg, Contains("gmres") && Contains("progressive_refinement"));
        CHECK(svg.find("nan") == svg.npos);
        CHECK(svg.find("no run to show") == svg.npos);
    }
    CHECK_THAT(place.read("out/study.md"), Contains("## Solvers") &&
                                               Contains("| gmres | gmres |") &&
                                               Contains("plots/solver_unshot_cpu.svg"));
}
