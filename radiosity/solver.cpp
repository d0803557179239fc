#include "radiosity/solver.h"

#include <algorithm>
#include <cmath>

namespace tyndall::radiosity {

std::vector<double> reflect(const LinearProblem& problem, std::span<const double> radiance) {
    std::vector<double> result = multiply(problem.areas, problem.elements, radiance);
    for (std::size_t i = 0; i < result.size(); ++i) result[i] *= problem.scatter_over_capacity(i);
    return result;
}

std::vector<double> left_of(const LinearProblem& problem, std::span<const double> radiance) {
    return left_of(problem, radiance, multiply(problem.areas, problem.elements, radiance));
}

std::vector<double> left_of(const LinearProblem& problem, std::span<const double> radiance,
                            std::span<const double> received) {
    std::vector<double> left(radiance.size());
    for (std::size_t i = 0; i < left.size(); ++i)
        left[i] = problem.source[i] + problem.scatter_over_capacity(i) * received[i] - radiance[i];
    return left;
}

double norm_of(std::span<const double> values) {
    double square = 0.0;
    for (const double value : values) square += value * value;
    return std::sqrt(square);
}

SolverResult finish(const LinearProblem& problem, const SolverOptions& options,
                    std::vector<double> radiance, std::size_t iterations, SolverHistory& history,
                    std::vector<double> received) {
    SolverResult result;
    const bool numbers =
        std::all_of(radiance.begin(), radiance.end(), [](double x) { return std::isfinite(x); });
    if (!numbers) {
        radiance.assign(radiance.size(), 0.0);
        received.clear();
    }
    result.radiance = std::move(radiance);
    result.iterations = iterations;
    result.received = received.empty() ? multiply(problem.areas, problem.elements, result.radiance)
                                       : std::move(received);
    const std::vector<double> left = left_of(problem, result.radiance, result.received);
    result.residual = norm_of(left) / history.source_norm();
    const bool grows = norm_of(result.radiance) > diverged * history.source_norm();
    result.converged = numbers && !grows && result.residual <= options.tolerance;
    history.note_end(iterations, result.radiance, left);
    result.history = history.take();
    return result;
}

SolverResult dark(const LinearProblem& problem) {
    SolverResult result;
    result.radiance.assign(problem.elements.size(), 0.0);
    result.received = result.radiance;
    result.converged = true;
    return result;
}

}  // namespace tyndall::radiosity
