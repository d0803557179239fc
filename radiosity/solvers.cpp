#include "radiosity/solvers.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "mesh/input_error.h"
#include "radiosity/solver_bicgstab.h"
#include "radiosity/solver_direct.h"
#include "radiosity/solver_gauss_seidel.h"
#include "radiosity/solver_gmres.h"
#include "radiosity/solver_jacobi.h"
#include "radiosity/solver_progressive_refinement.h"

namespace tyndall::radiosity {
namespace {

constexpr NamedSolver named_solvers[]{
    {.name = "gmres", .solver = solve_gmres},
    {.name = "bicgstab", .solver = solve_bicgstab},
    {.name = "gauss_seidel", .solver = solve_gauss_seidel, .relaxes = true},
    {.name = "jacobi", .solver = solve_jacobi, .relaxes = true},
    {.name = "progressive_refinement", .solver = solve_progressive_refinement, .shoots = true},
    {.name = "direct", .solver = solve_direct, .most_elements = most_direct_elements},
};

struct Family {
    std::string_view name, member;
};
constexpr Family families[]{{"gathering", "gauss_seidel"}, {"krylov", "gmres"}};

// The names of the solvers that have an ability.
std::string able(bool NamedSolver::*ability) {
    std::vector<std::string_view> names;
    for (const auto& solver : named_solvers)
        if (solver.*ability) names.push_back(solver.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

SolverTrouble unknown_to(const NamedSolver& solver, std::string_view key, std::string_view usual,
                         bool NamedSolver::*ability) {
    return {key,
            fmt::format("solver \"{}\" knows no {}. Set solve.{} to {}, or solve.solver to one "
                        "of {}.",
                        solver.name, key, key, usual, able(ability))};
}

}  // namespace

std::span<const NamedSolver> solvers() {
    return named_solvers;
}

std::vector<std::string_view> solver_names() {
    std::vector<std::string_view> names;
    for (const auto& solver : named_solvers) names.push_back(solver.name);
    for (const auto& family : families) names.push_back(family.name);
    return names;
}

const NamedSolver& solver_named(std::string_view name) {
    const auto family = std::ranges::find(families, name, &Family::name);
    const auto wanted = family == std::end(families) ? name : family->member;
    const auto found = std::ranges::find(named_solvers, wanted, &NamedSolver::name);
    if (found != std::end(named_solvers)) return *found;
    throw mesh::InputError(fmt::format("there is no solver \"{}\". Choose one of {}.", name,
                                       fmt::join(solver_names(), ", ")));
}

std::optional<SolverTrouble> solver_trouble(const SolveOptions& options) {
    const NamedSolver& solver = solver_named(options.solver);
    if (!(options.over_relaxation > 0.0) || !(options.over_relaxation < 2.0))
        return SolverTrouble{
            "over_relaxation",
            fmt::format("over_relaxation is {}, and with that no iteration converges. Set it above "
                        "0 and below 2.",
                        options.over_relaxation)};
    if (options.over_relaxation != 1.0 && !solver.relaxes)
        return unknown_to(solver, "over_relaxation", "1", &NamedSolver::relaxes);
    if (options.overshooting && !solver.shoots)
        return unknown_to(solver, "overshooting", "false", &NamedSolver::shoots);
    if (options.ambient && !solver.shoots)
        return unknown_to(solver, "ambient", "false", &NamedSolver::shoots);
    if (options.shots == Shots::rows) return std::nullopt;
    if (!solver.shoots) return unknown_to(solver, "shots", "\"rows\"", &NamedSolver::shoots);
    if (options.exchange_settings.smoothing != Smoothing::none)
        return SolverTrouble{
            "smoothing",
            "smoothing needs all rows at once, and shots on the fly keep none. Set "
            "smoothing to \"none\", or shots to \"rows\"."};
    if (options.row_detail > 0.0)
        return SolverTrouble{
            "row_detail",
            fmt::format("level of detail in rows (row_detail = {}) saves memory of rows, and shots "
                        "on the fly keep none. Set row_detail to 0, or shots to \"rows\".",
                        options.row_detail)};
    return std::nullopt;
}

void check_solver(const SolveOptions& options) {
    if (const auto trouble = solver_trouble(options)) throw mesh::InputError(trouble->message);
}

void check_solver_size(const NamedSolver& solver, std::size_t elements) {
    if (solver.most_elements > 0 && elements > solver.most_elements) check_direct_size(elements);
}

}  // namespace tyndall::radiosity
