// What solvers tell of their way.
#include <cmath>

#include "radiosity/report_json.h"
#include "radiosity/solver_history.h"
#include "radiosity/solver_jacobi.h"
#include "radiosity/solver_progressive_refinement.h"
#include "support/catch.h"
#include "support/foggy_system.h"

using namespace tyndall;
using namespace tyndall::radiosity;
using test::FoggyBox;

TEST_CASE("Histories are thinned, and keep both ends", "[solvers]") {
    const FoggyBox box(0.99, 0.99);
    const SolverResult result =
        solve_jacobi(box.problem(), {.tolerance = 1e-6, .iterations = 10'000});
    REQUIRE(result.converged);
    CHECK(result.iterations > 1000);
    CHECK(result.history.size() <= SolverHistory::most);
    CHECK(result.history.size() >= SolverHistory::most / 2);
    CHECK(result.history.front().iterations == 0);
    CHECK(result.history.back().iterations == result.iterations);
    for (std::size_t k = 1; k < result.history.size(); ++k) {
        CHECK(result.history[k].iterations > result.history[k - 1].iterations);
        CHECK(result.history[k].cpu_seconds >= result.history[k - 1].cpu_seconds);
    }
    // In the end what has been brought in has ended somewhere, as far as rows are reciprocal.
    CHECK(std::abs(result.history.back().energy_balance) < 0.05);
    CHECK(result.history.back().unshot_power < 1e-4 * result.history.front().unshot_power);
}

TEST_CASE("A report keeps its solver's history", "[solvers]") {
    const FoggyBox box(0.9, 0.8);
    const SolverResult result = solve_progressive_refinement(box.problem(), {.tolerance = 1e-3});
    Report report;
    report.solver = {"progressive_refinement",
                     result.iterations,
                     result.residual,
                     result.converged,
                     result.shots,
                     result.history.back().unshot_power,
                     result.history};
    const Report again = report_from_json(report_to_json(report, Costs::kept));
    CHECK(again.solver.shots == result.shots);
    CHECK(again.solver.unshot_power == report.solver.unshot_power);
    REQUIRE(again.solver.history.size() == result.history.size());
    for (std::size_t k = 0; k < result.history.size(); ++k) {
        const SolverStep &a = result.history[k], &b = again.solver.history[k];
        CHECK(a.iterations == b.iterations);
        CHECK(a.shots == b.shots);
        CHECK(a.residual == b.residual);
        CHECK(a.unshot_power == b.unshot_power);
        CHECK(a.energy_balance == b.energy_balance);
        CHECK(a.ambient == b.ambient);
        CHECK(a.cpu_seconds == b.cpu_seconds);
    }
    // Solution files are the same at any number of threads: no seconds in them.
    CHECK(report_to_json(report, Costs::left_out).find("seconds") == std::string::npos);
}
