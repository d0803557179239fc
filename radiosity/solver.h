// The linear system of the one equation, and what every solver takes and gives.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "radiosity/exchange.h"
#include "radiosity/solver_history.h"

namespace tyndall::radiosity {

// Makes rows and forgets them: those of the elements asked for, in that order.
using RowMaker = std::function<void(std::span<const ElementId>, const RowSink&)>;

// x_i = s_i + a_i/c_i Σ_j S_ij x_j   over patches and zones alike, with what comes from outside and
// the direct light already in s. One band.
struct LinearProblem {
    const Elements& elements;
    const ExchangeAreas& areas;  // without rows where `rows` is given
    std::size_t band = 0;
    std::span<const double> source;  // s [W/m^2/sr], one an element
    RowMaker rows{};                 // for shots on the fly; of elements alone, without moments
    // S_i,out [m^2]; empty: with `rows` the scene is closed, without they are looked up in `areas`.
    std::span<const double> outside{};

    double capacity(std::size_t i) const { return elements.capacity[i * elements.bands + band]; }
    double scatter(std::size_t i) const { return elements.scatter[i * elements.bands + band]; }
    // a/c, 0 for an element without capacity [1/m^2].
    double scatter_over_capacity(std::size_t i) const {
        return capacity(i) > 0.0 ? scatter(i) / capacity(i) : 0.0;
    }
};

struct SolverOptions {
    double tolerance = 1e-6;       // |s − A x| / |s| [-]
    std::size_t iterations = 200;  // passes over the entries, at most (SolverStep)
    double over_relaxation = 1.0;  // of jacobi and gauss_seidel, 0 to 2 [-]
    bool overshooting = false;     // of progressive_refinement
    bool ambient = false;          //   adds the ambient estimate where it ends before its tolerance
    // Of progressive refinement: the elements with at least this share of the largest unshot power
    // shoot before the largest is looked for again; 1: that one alone [-].
    double shooters = 0.7;
    ProgressCallback progress{};  // after every step of the history
    bool balance = true;          // told by the history, for which it takes a pass over the entries
    // x to begin with, one an element; empty: 0. GMRES alone uses it.
    std::span<const double> guess{};
};

struct SolverResult {
    std::vector<double> radiance;  // x [W/m^2/sr]
    std::size_t iterations = 0;
    double residual = 0.0;  // relative, measured, not the recurrence's [-]
    bool converged = false;
    bool stopped = false;            // by the caller's progress
    std::vector<double> received{};  // Σ_j S_ij x_j, outside left out [W/sr]
    std::size_t shots = 0;           // of progressive refinement
    std::vector<SolverStep> history{};
};

using Solver = SolverResult (*)(const LinearProblem&, const SolverOptions&);

// a_i/c_i Σ_j S_ij x_j for every element, outside left out. Cost: one pass over the entries, in
// parallel.
std::vector<double> reflect(const LinearProblem& problem, std::span<const double> radiance);

// ρ = s + a/c S x − x. Cost: the same; none where `received`, S x, is known.
std::vector<double> left_of(const LinearProblem& problem, std::span<const double> radiance);
std::vector<double> left_of(const LinearProblem& problem, std::span<const double> radiance,
                            std::span<const double> received);

// |ρ| / |s| from which on an iteration has gone wrong for good; and |x| / |s| that no scene has
// that absorbs anything: rows in single precision close to 1e-7, and where nothing is lost their
// rounding is all that ends the light.
inline constexpr double diverged = 1e6;

double norm_of(std::span<const double> values);

// What all solvers end with: S x, the residual measured, whether it is as small as asked for. Where
// a solver has failed so far that x is no number, x is 0 and not converged. `received`: S x, where
// a solver knows it. Cost: one pass without.
SolverResult finish(const LinearProblem& problem, const SolverOptions& options,
                    std::vector<double> radiance, std::size_t iterations, SolverHistory& history,
                    std::vector<double> received = {});

// The result where s is 0: nothing shines.
SolverResult dark(const LinearProblem& problem);

}  // namespace tyndall::radiosity
