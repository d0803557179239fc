// The solvers by name.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "radiosity/solver.h"

namespace tyndall::radiosity {

struct NamedSolver {
    std::string_view name;
    Solver solver;
    bool relaxes = false;           // heeds over_relaxation
    bool shoots = false;            // heeds shots, overshooting, ambient
    std::size_t most_elements = 0;  // 0: any number
};

// The default first.
std::span<const NamedSolver> solvers();

// All names that solver_named takes: those, and the names of two families, "gathering" for
// gauss_seidel and "krylov" for gmres.
std::vector<std::string_view> solver_names();

// Errors: mesh::InputError that lists the names there are.
const NamedSolver& solver_named(std::string_view name);

// What is wrong with a key of [solve], and what to do.
struct SolverTrouble {
    std::string_view key;
    std::string message;
};

// Whether the options ask the solver for what it does not know, or for shots on the fly with what
// needs all rows (smoothing, level of detail), or over_relaxation is not between 0 and 2.
// Errors: mesh::InputError for a solver that there is not.
std::optional<SolverTrouble> solver_trouble(const SolveOptions& options);

// Errors: mesh::InputError if there is such trouble.
void check_solver(const SolveOptions& options);

// Errors: mesh::InputError if there are more elements than the solver takes.
void check_solver_size(const NamedSolver& solver, std::size_t elements);

}  // namespace tyndall::radiosity
