#include "radiosity/solver_jacobi.h"

namespace tyndall::radiosity {

SolverResult solve_jacobi(const LinearProblem& problem, const SolverOptions& options) {
    if (norm_of(problem.source) == 0.0) return dark(problem);
    SolverHistory history(problem, options);
    std::vector<double> x(problem.elements.size(), 0.0);
    std::vector<double> left(problem.source.begin(), problem.source.end());
    history.note(0, x, left);
    std::size_t iterations = 0;
    bool stopped = false;
    for (double residual = 1.0;
         residual > options.tolerance && residual < diverged && iterations < options.iterations;) {
        for (std::size_t i = 0; i < x.size(); ++i) x[i] += options.over_relaxation * left[i];
        left = left_of(problem, x);  // (37)
        residual = norm_of(left) / history.source_norm();
        stopped = !history.note(++iterations, x, left);
        if (stopped) break;
    }
    SolverResult result = finish(problem, options, std::move(x), iterations, history);
    result.stopped = stopped;
    return result;
}

}  // namespace tyndall::radiosity
