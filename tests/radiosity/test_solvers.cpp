// Every solver against the dense LU, against each other, and against what theory says of each.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/input_error.h"
#include "radiosity/solver_bicgstab.h"
#include "radiosity/solver_direct.h"
#include "radiosity/solver_gauss_seidel.h"
#include "radiosity/solver_gmres.h"
#include "radiosity/solver_jacobi.h"
#include "radiosity/solver_progressive_refinement.h"
#include "radiosity/solvers.h"
#include "support/catch.h"
#include "support/foggy_system.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

using test::FoggyBox;
using test::Rows;

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
    REQUIRE(a.size() == b.size());
    double largest = 0.0, scale = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        REQUIRE(std::isfinite(a[i]));
        largest = std::max(largest, std::abs(a[i] - b[i]));
        scale = std::max(scale, std::abs(b[i]));
    }
    return largest / scale;
}

// The rows that have S_ij where these have S_ji.
ExchangeAreas transposed(const ExchangeAreas& areas, const Elements& elements) {
    std::vector<std::vector<double>> dense(elements.size(),
                                           std::vector<double>(elements.size(), 0.0));
    for (std::size_t i = 0; i < areas.rows(); ++i)
        for (std::size_t k = areas.starts[i]; k < areas.starts[i + 1]; ++k)
            if (areas.columns[k] < elements.size()) dense[areas.columns[k]][i] = areas.value(k);
    ExchangeAreas result;
    for (std::size_t i = 0; i < dense.size(); ++i) {
        for (std::size_t j = 0; j < dense.size(); ++j) {
            result.columns.push_back(static_cast<std::uint32_t>(j));
            result.values.push_back(static_cast<float>(dense[i][j]));
        }
        result.starts.push_back(result.columns.size());
    }
    return result;
}

std::size_t iterations_of(Solver solver, const LinearProblem& problem, double tolerance) {
    const SolverResult result = solver(problem, {.tolerance = tolerance, .iterations = 100'000});
    REQUIRE(result.converged);
    return result.iterations;
}

}  // namespace

TEST_CASE("Every solver finds the dense system's solution", "[solvers]") {
    const double albedo = GENERATE(0.0, 0.5, 0.9, 1.0);
    const double reflectance = GENERATE(0.0, 0.5, 0.95);
    const Rows rows = GENERATE(Rows::constant, Rows::linear, Rows::detail, Rows::smoothed);
    const double extinction = GENERATE(0.2, 1.0, 8.0);  // zones of a metre
    const FoggyBox box(albedo, reflectance, rows, extinction);
    const SolverResult exact = solve_direct(box.problem(), {});
    REQUIRE(exact.converged);
    // Moments multiply gradients in single precision when x is multiplied as a whole, 6e-8 off.
    const double rounding = rows == Rows::linear ? 1e-6 : 0.0;
    const double tolerance = rows == Rows::linear ? 1e-6 : 1e-10;
    for (const auto& named : solvers()) {
        CAPTURE(albedo, reflectance, extinction, static_cast<int>(rows), named.name);
        const SolverResult result =
            named.solver(box.problem(), {.tolerance = tolerance, .iterations = 10'000});
        CHECK(result.converged);
        CHECK(result.residual <= tolerance);
        // What a residual leaves is amplified by 1 / (1 − spectral radius): here at most 41, of
        // walls that keep 95 % in a fog that keeps all.
        CHECK(largest_difference(result.radiance, exact.radiance) < 100.0 * tolerance + rounding);
        for (std::size_t i = 0; i < box.elements.size(); ++i)
            if (box.elements.capacity[i] > 0.0)
                CHECK(box.elements.emission[i] +
                          box.elements.scatter[i] * result.received[i] / box.elements.capacity[i] ==
                      Approx(result.radiance[i]).margin(100.0 * tolerance + rounding));
    }
}

TEST_CASE("GMRES begins with a guess, and ends where it would without", "[solvers]") {
    const FoggyBox box(0.9, 0.7);
    constexpr double tolerance = 1e-9;
    const SolverResult plain = solve_gmres(box.problem(), {.tolerance = tolerance});
    REQUIRE(plain.converged);
    REQUIRE(plain.iterations > 5);
    const SolverResult there =
        solve_gmres(box.problem(), {.tolerance = tolerance, .guess = plain.radiance});
    CHECK(there.converged);
    CHECK(there.iterations == 0);
    CHECK(there.radiance == plain.radiance);
    std::vector<double> near = plain.radiance;
    for (std::size_t i = 0; i < near.size(); ++i) near[i] *= i % 2 ? 1.01 : 0.99;
    const SolverResult result = solve_gmres(box.problem(), {.tolerance = tolerance, .guess = near});
    CHECK(result.converged);
    CHECK(result.iterations < plain.iterations);
    CHECK(largest_difference(result.radiance, plain.radiance) < 100.0 * tolerance);
}

TEST_CASE("Shots on the fly solve the system of the reversed rows", "[solvers]") {
    const double albedo = GENERATE(0.5, 1.0);
    const FoggyBox box(albedo, 0.7);
    const ExchangeAreas reversed = transposed(box.areas, box.elements);
    const SolverResult exact =
        solve_direct({box.elements, reversed, 0, box.elements.emission}, {.tolerance = 1e-9});
    const SolverResult shot =
        solve_progressive_refinement(box.on_the_fly(), {.tolerance = 1e-9, .iterations = 10'000});
    REQUIRE(shot.converged);
    // Kept rows are rounded to single precision; rows on the fly are not.
    CHECK(largest_difference(shot.radiance, exact.radiance) < 1e-5);

    // What S_ij and S_ji differ by is all that parts it from the solution of the kept rows.
    const SolverResult kept = solve_direct(box.problem(), {});
    double difference = 0.0, whole = 0.0;
    for (std::size_t i = 0; i < box.elements.size(); ++i) {
        difference += box.elements.capacity[i] * std::abs(shot.radiance[i] - kept.radiance[i]);
        whole += box.elements.capacity[i] * kept.radiance[i];
    }
    CAPTURE(difference / whole, reciprocity_error(box.areas, box.elements));
    CHECK(difference < reciprocity_error(box.areas, box.elements) * whole);
    CHECK(difference > 1e-4 * whole);
}

TEST_CASE("Shots on the fly lose no power on the way", "[solvers]") {
    const FoggyBox box(0.8, 0.6);
    const SolverResult shot =
        solve_progressive_refinement(box.on_the_fly(), {.tolerance = 1e-6, .iterations = 1000});
    double brought = 0.0;
    for (std::size_t i = 0; i < box.elements.size(); ++i)
        brought += std::numbers::pi * box.elements.capacity[i] * box.elements.emission[i];
    REQUIRE(shot.history.size() > 20);
    CHECK(shot.history.front().unshot_power == Approx(brought));
    for (std::size_t k = 0; k < shot.history.size(); ++k) {
        const SolverStep& step = shot.history[k];
        // What has been brought in and has not ended anywhere is unshot: an identity, as far as
        // walked rows close (1e-12).
        CHECK(step.energy_balance * brought ==
              Approx(step.unshot_power).epsilon(1e-9).margin(1e-9 * brought));
        if (k > 0) CHECK(step.unshot_power < shot.history[k - 1].unshot_power);
    }
}

TEST_CASE("Jacobi's rate is the share that everything scatters", "[solvers]") {
    // Rows close: with one a everywhere a/c S has rows that sum up to a, so that its spectral
    // radius is a, to the last bit of single precision.
    const double a = GENERATE(0.3, 0.8, 0.95);
    const FoggyBox box(a, a);
    const SolverResult result =
        solve_jacobi(box.problem(), {.tolerance = 1e-9, .iterations = 10'000});
    REQUIRE(result.converged);
    const auto& history = result.history;
    REQUIRE(history.size() > 10);
    const SolverStep &later = history[history.size() - 2], &before = history[history.size() - 4];
    const double rate = std::pow(later.residual / before.residual,
                                 1.0 / double(later.iterations - before.iterations));
    CHECK(rate == Approx(a).epsilon(1e-3));
    // k iterations are k bounces: the light that is left after them is a^k of the first, if
    // reciprocity held for the power; it holds to some per cent.
    CHECK(double(result.iterations) ==
          Approx(std::log(1e-9) / std::log(a)).epsilon(0.15).margin(1.0));
}

TEST_CASE("Gathering one after the other is faster than all at once, relaxed even more",
          "[solvers]") {
    const FoggyBox box(0.95, 0.9);
    const std::size_t jacobi = iterations_of(solve_jacobi, box.problem(), 1e-8);
    const std::size_t gauss_seidel = iterations_of(solve_gauss_seidel, box.problem(), 1e-8);
    CAPTURE(jacobi, gauss_seidel);
    CHECK(gauss_seidel < 0.65 * jacobi);
    const SolverResult relaxed = solve_gauss_seidel(
        box.problem(), {.tolerance = 1e-8, .iterations = 10'000, .over_relaxation = 1.3});
    CHECK(relaxed.converged);
    CHECK(relaxed.iterations < gauss_seidel);
    const SolverResult damped = solve_jacobi(
        box.problem(), {.tolerance = 1e-8, .iterations = 10'000, .over_relaxation = 0.5});
    CHECK(damped.converged);
    CHECK(damped.iterations > 1.8 * jacobi);
}

TEST_CASE("GMRES leaves less than any other after as many passes", "[solvers]") {
    // Jacobi's iterates and BiCGSTAB's lie in the space of which GMRES takes the best, up to the
    // restart after 40.
    const FoggyBox box(0.95, 0.9);
    const auto history_of = [&](Solver solver) {
        return solver(box.problem(), {.tolerance = 1e-10, .iterations = 40}).history;
    };
    const auto gmres = history_of(solve_gmres);
    for (const Solver other : {solve_jacobi, solve_bicgstab})
        for (const SolverStep& step : history_of(other))
            if (step.iterations < gmres.size())
                CHECK(gmres[step.iterations].residual <= step.residual * (1.0 + 1e-6) + 1e-14);
    // Its history's residual, from the small system, is the one that is measured in the end.
    const SolverResult result = solve_gmres(box.problem(), {.tolerance = 1e-3});
    const auto& last = result.history[result.history.size() - 1];
    CHECK(last.residual == Approx(result.residual));
    CHECK(last.iterations == result.iterations);
    CHECK(last.residual == Approx(gmres[result.iterations].residual).epsilon(1e-6));
}

TEST_CASE("The element with the most unshot power shoots", "[solvers]") {
    // Two shots by hand: the largest c s first, then the largest c Δ of what that made.
    FoggyBox box(0.8, 0.6, Rows::constant, 0.5);
    std::vector<double> source(box.elements.size(), 0.0);
    source[3] = 2.0;
    source[box.elements.patches.size() + 5] = 1.0;  // a zone
    const LinearProblem problem{box.elements, box.areas, 0, source};
    std::vector<double> unshot = source, x = source;
    for (int shot = 0; shot < 7; ++shot) {
        std::size_t most = 0;
        for (std::size_t i = 0; i < unshot.size(); ++i)
            if (problem.capacity(i) * unshot[i] > problem.capacity(most) * unshot[most]) most = i;
        const double self = problem.scatter_over_capacity(most) *
                            entry(box.areas, most, static_cast<std::uint32_t>(most));
        const double power = unshot[most] / (1.0 - self);
        unshot[most] -= power;
        for (std::size_t j = 0; j < unshot.size(); ++j) {
            const double arrived = problem.scatter_over_capacity(j) *
                                   entry(box.areas, j, static_cast<std::uint32_t>(most)) * power;
            unshot[j] += arrived;
            x[j] += arrived;
        }
    }
    // Seven shots are less than one of every element: the caller ends it.
    std::size_t told = 0;
    const SolverResult result = solve_progressive_refinement(
        problem, {.shooters = 1.0, .progress = [&](const Progress&) { return ++told <= 7; }});
    CHECK_FALSE(result.converged);
    REQUIRE(result.shots == 7);
    CHECK(largest_difference(result.radiance, x) < 1e-12);
}

TEST_CASE("Overshooting needs fewer shots where much is scattered", "[solvers]") {
    const FoggyBox box(0.95, 0.95);
    const auto shots = [&](bool overshooting, const LinearProblem& problem) {
        const SolverResult result = solve_progressive_refinement(
            problem, {.tolerance = 1e-4, .iterations = 10'000, .overshooting = overshooting});
        REQUIRE(result.converged);
        const SolverResult exact = solve_gmres(box.problem(), {.tolerance = 1e-10});
        if (!problem.rows) CHECK(largest_difference(result.radiance, exact.radiance) < 0.01);
        return result.shots;
    };
    CHECK(double(shots(true, box.problem())) < 0.6 * double(shots(false, box.problem())));
    CHECK(double(shots(true, box.on_the_fly())) < 0.6 * double(shots(false, box.on_the_fly())));
}

TEST_CASE("The ambient estimate stands in for what is unshot", "[solvers]") {
    const FoggyBox box(0.9, 0.8);
    const SolverResult exact = solve_direct(box.problem(), {});
    const auto error = [&](bool ambient, std::size_t iterations) {
        const SolverResult result = solve_progressive_refinement(
            box.problem(), {.tolerance = 1e-6, .iterations = iterations, .ambient = ambient});
        CHECK_FALSE(result.converged);
        double sum = 0.0, whole = 0.0;
        for (std::size_t i = 0; i < result.radiance.size(); ++i) {
            sum += box.elements.capacity[i] * (result.radiance[i] - exact.radiance[i]);
            whole += box.elements.capacity[i] * exact.radiance[i];
        }
        return sum / whole;
    };
    for (const std::size_t iterations : {1, 3}) {
        CAPTURE(error(false, iterations), error(true, iterations));
        CHECK(error(false, iterations) < -0.05);  // too dark
        CHECK(std::abs(error(true, iterations)) < 0.3 * std::abs(error(false, iterations)));
    }
}

TEST_CASE("Where nothing absorbs, solvers say so and end", "[solvers]") {
    const FoggyBox box(1.0, 1.0);
    for (const auto& named : solvers()) {
        CAPTURE(named.name);
        const SolverResult lit = named.solver(box.problem(), {.iterations = 2000});
        CHECK_FALSE(lit.converged);
        for (const double x : lit.radiance) REQUIRE(std::isfinite(x));
        for (const double x : lit.received) REQUIRE(std::isfinite(x));
        CHECK(std::isfinite(lit.residual));
        const std::vector<double> nothing(box.elements.size(), 0.0);
        const SolverResult dark = named.solver({box.elements, box.areas, 0, nothing}, {});
        CHECK(dark.converged);
        CHECK(dark.residual == 0.0);
        CHECK(dark.radiance == nothing);
        CHECK(dark.received == nothing);
    }
    const SolverResult shot = solve_progressive_refinement(box.problem(), {.iterations = 2000});
    CHECK(shot.shots < 20 * box.elements.size());
    const SolverResult fly = solve_progressive_refinement(box.on_the_fly(), {.iterations = 2000});
    CHECK_FALSE(fly.converged);
    CHECK(fly.shots < 20 * box.elements.size());
}

TEST_CASE("Too few iterations are a result", "[solvers]") {
    const FoggyBox box(0.9, 0.8);
    for (const auto& named : solvers()) {
        if (named.name == "direct") continue;
        CAPTURE(named.name);
        const SolverResult result =
            named.solver(box.problem(), {.tolerance = 1e-9, .iterations = 4});
        CHECK_FALSE(result.converged);
        CHECK(result.iterations <= 5);
        CHECK(result.residual > 1e-9);
        CHECK(result.residual < 1.0);
        CHECK(result.history.front().residual == Approx(1.0));
        CHECK(result.history.front().iterations == 0);
        CHECK(result.history.back().iterations == result.iterations);
    }
}

TEST_CASE("With a tolerance beyond what doubles tell every solver ends, at the solution",
          "[solvers]") {
    const Rows rows = GENERATE(Rows::constant, Rows::linear);
    const FoggyBox box(0.9, 0.8, rows);
    const SolverResult exact = solve_direct(box.problem(), {});
    for (const auto& named : solvers()) {
        CAPTURE(named.name);
        const SolverResult result = named.solver(box.problem(), {.tolerance = 1e-18});
        CHECK(largest_difference(result.radiance, exact.radiance) < 1e-6);
    }
}

TEST_CASE("A caller can end every solver that iterates", "[solvers]") {
    const FoggyBox box(0.9, 0.8);
    for (const auto& named : solvers()) {
        if (named.name == "direct") continue;
        CAPTURE(named.name);
        std::size_t told = 0;
        const SolverResult result =
            named.solver(box.problem(), {.tolerance = 1e-9, .progress = [&](const Progress& now) {
                                             CHECK(now.stage == "linear system");
                                             return ++told < 3;
                                         }});
        CHECK(told == 3);
        CHECK_FALSE(result.converged);
        CHECK(result.stopped);
    }
}

TEST_CASE("Solvers by name", "[solvers]") {
    CHECK(solvers().front().name == "gmres");
    CHECK(solver_named("gathering").name == "gauss_seidel");
    CHECK(solver_named("krylov").name == "gmres");
    CHECK_THROWS_WITH(solver_named("conjugate_gradients"),
                      Contains("there is no solver \"conjugate_gradients\"") &&
                          Contains("bicgstab") && Contains("gathering"));
    CHECK_NOTHROW(check_solver(
        {.solver = "progressive_refinement", .shots = Shots::on_the_fly, .overshooting = true}));
    CHECK_THROWS_WITH(check_solver({.shots = Shots::on_the_fly}),
                      Contains("\"gmres\" knows no shots") && Contains("progressive_refinement"));
    CHECK_THROWS_WITH(check_solver({.over_relaxation = 1.2}), Contains("gauss_seidel, jacobi"));
    CHECK_THROWS_WITH(check_solver({.solver = "jacobi", .over_relaxation = 2.0}),
                      Contains("over_relaxation is 2"));
    CHECK_THROWS_WITH(check_solver({.exchange_settings = {.smoothing = Smoothing::scaling},
                                    .solver = "progressive_refinement",
                                    .shots = Shots::on_the_fly}),
                      Contains("smoothing needs all rows"));
    CHECK_THROWS_WITH(
        check_solver(
            {.solver = "progressive_refinement", .shots = Shots::on_the_fly, .row_detail = 1.0}),
        Contains("row_detail = 1"));
    CHECK_NOTHROW(check_solver_size(solver_named("gmres"), 1'000'000));
    CHECK_THROWS_WITH(check_solver_size(solver_named("direct"), 20'000),
                      Contains("up to 6000 elements") && Contains("20000") && Contains("gmres"));
}
