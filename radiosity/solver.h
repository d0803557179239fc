// The linear system of the one equation, and what every solver takes and gives.
#pragma once

#include <span>
#include <vector>

#include "radiosity/exchange.h"

namespace tyndall::radiosity {

// x_i = s_i + a_i/c_i Σ_j S_ij x_j   over patches and zones alike, with what comes from outside and
// the direct light already in s. One band.
struct LinearProblem {
    const Elements& elements;
    const ExchangeAreas& areas;
    std::size_t band = 0;
    std::span<const double> source;  // s [W/m^2/sr], one an element
};

struct SolverOptions {
    double tolerance = 1e-6;       // |s − A x| / |s| [-]
    std::size_t iterations = 200;  // at most
};

struct SolverResult {
    std::vector<double> radiance;  // x [W/m^2/sr]
    std::size_t iterations = 0;
    double residual = 0.0;  // relative, measured, not the recurrence's [-]
    bool converged = false;
};

using Solver = SolverResult (*)(const LinearProblem&, const SolverOptions&);

// a_i/c_i Σ_j S_ij x_j for every element, outside left out. Cost: one pass over the entries, in
// parallel.
std::vector<double> reflect(const LinearProblem& problem, std::span<const double> radiance);

// GMRES (Saad & Schultz 1986), restarted after 40 steps, by Eigen. Valid for every a ≤ 1 with some
// loss. 10–20 iterations to 1e-6 whatever the size; not converged is a result, not an error.
SolverResult solve_gmres(const LinearProblem& problem, const SolverOptions& options);

}  // namespace tyndall::radiosity
