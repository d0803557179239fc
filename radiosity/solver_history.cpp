#include "radiosity/solver_history.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "radiosity/column_shares.h"
#include "radiosity/resources.h"
#include "radiosity/solver.h"

namespace tyndall::radiosity {

double ambient_estimate(const LinearProblem& problem, std::span<const double> unshot,
                        double outside_area) {
    double power = 0.0, scattered = 0.0, whole = outside_area;
    for (std::size_t i = 0; i < unshot.size(); ++i) {
        const double c = problem.capacity(i);
        power += c * unshot[i];
        scattered += c * problem.scatter(i);
        whole += c;
    }
    const double absorbed = whole - scattered;  // C (1 − ā)
    return absorbed > 1e-12 * whole ? power / absorbed : 0.0;
}

double outside_area(const LinearProblem& problem) {
    double sum = 0.0;
    if (problem.rows || !problem.outside.empty()) {
        for (const double area : problem.outside) sum += area;
    } else {
        for (std::size_t i = 0; i < problem.elements.size(); ++i)
            sum += to_outside(problem.areas, problem.elements, i);
    }
    return sum;
}

SolverHistory::SolverHistory(const LinearProblem& problem, const SolverOptions& options)
    : problem_(problem), options_(options), source_norm_(norm_of(problem.source)) {
    for (std::size_t i = 0; i < problem.source.size(); ++i)
        brought_ += problem.capacity(i) * problem.source[i];
    outside_area_ = outside_area(problem);
    if (!problem.rows && options.balance)
        ends_ = ends_of_light(problem, ColumnShares(problem.areas, problem.elements));
    began_ = cpu_seconds();
}

SolverHistory::Uncounted::Uncounted(SolverHistory& history) : history_(history) {
    if (history_.pauses_++ == 0) history_.paused_at_ = cpu_seconds();
}

SolverHistory::Uncounted::~Uncounted() {
    if (--history_.pauses_ == 0) history_.uncounted_ += cpu_seconds() - history_.paused_at_;
}

double SolverHistory::ended(std::size_t element, double radiance) const {
    return ends_.empty() ? std::numeric_limits<double>::quiet_NaN() : ends_[element] * radiance;
}

double SolverHistory::ended_of(std::span<const double> x) const {
    double ended = ends_.empty() ? std::numeric_limits<double>::quiet_NaN() : 0.0;
    for (std::size_t i = 0; i < ends_.size(); ++i) ended += ends_[i] * x[i];
    return ended;
}

// Called while the clock is paused.
SolverStep SolverHistory::step_of(std::size_t iterations, double ended,
                                  std::span<const double> left) const {
    double unshot = 0.0;
    for (std::size_t i = 0; i < left.size(); ++i)
        unshot += problem_.capacity(i) * std::abs(left[i]);
    SolverStep step;
    step.band = problem_.band;
    step.iterations = iterations;
    step.cpu_seconds = std::max(0.0, paused_at_ - began_ - uncounted_);
    step.residual = source_norm_ > 0.0 ? norm_of(left) / source_norm_ : 0.0;
    step.unshot_power = std::numbers::pi * unshot;
    step.energy_balance = brought_ > 0.0 ? (brought_ - ended) / brought_ : 0.0;
    step.ambient = ambient_estimate(problem_, left, outside_area_);
    return step;
}

void SolverHistory::keep(const SolverStep& step) {
    if (seen_++ % stride_ != 0) return;
    steps_.push_back(step);
    if (steps_.size() < most) return;
    for (std::size_t k = 0; 2 * k < steps_.size(); ++k) steps_[k] = steps_[2 * k];
    steps_.resize((steps_.size() + 1) / 2);
    stride_ *= 2;
}

void SolverHistory::keep_last(const SolverStep& step) {
    if (!steps_.empty() && steps_.back().iterations == step.iterations &&
        steps_.back().shots == step.shots)
        steps_.pop_back();
    steps_.push_back(step);
}

bool SolverHistory::tell(const SolverStep& step) const {
    const double fraction = step.residual > 0.0 && step.residual < 1.0
                                ? std::log(step.residual) / std::log(options_.tolerance)
                                : 0.0;
    return report(options_.progress, {"linear system", std::clamp(fraction, 0.0, 1.0),
                                      problem_.elements.size(), step.residual});
}

bool SolverHistory::note(std::size_t iterations, std::span<const double> x,
                         std::span<const double> left) {
    const Uncounted uncounted(*this);
    const SolverStep step = step_of(iterations, ended_of(x), left);
    keep(step);
    return tell(step);
}

bool SolverHistory::note_shots(std::size_t shots, double ended, std::span<const double> left) {
    const Uncounted uncounted(*this);
    const std::size_t n = std::max<std::size_t>(1, left.size());
    SolverStep step = step_of((shots + n - 1) / n, ended, left);
    step.shots = shots;
    // Closely at first, where most happens; then a hundred times whenever the shots grow tenfold.
    next_shots_ = shots + 1 + shots / 40;
    keep(step);
    return tell(step);
}

void SolverHistory::note_end(std::size_t iterations, std::span<const double> x,
                             std::span<const double> left) {
    const Uncounted uncounted(*this);
    keep_last(step_of(iterations, ended_of(x), left));
}

void SolverHistory::note_end_of_shots(std::size_t shots, double ended,
                                      std::span<const double> left) {
    const Uncounted uncounted(*this);
    const std::size_t n = std::max<std::size_t>(1, left.size());
    SolverStep step = step_of((shots + n - 1) / n, ended, left);
    step.shots = shots;
    keep_last(step);
}

}  // namespace tyndall::radiosity
