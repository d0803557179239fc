#include "radiosity/solver_bicgstab.h"

#include <Eigen/Core>
#include <cmath>

namespace tyndall::radiosity {
namespace {

using Vector = Eigen::VectorXd;

std::span<const double> numbers_of(const Vector& v) {
    return {v.data(), static_cast<std::size_t>(v.size())};
}

// The method's state. Names are those of the paper.
class BiConjugate {
  public:
    BiConjugate(const LinearProblem& problem, const SolverOptions& options)
        : problem_(problem),
          options_(options),
          history_(problem, options),
          x_(Vector::Zero(static_cast<Eigen::Index>(problem.elements.size()))),
          r_(Eigen::Map<const Vector>(problem.source.data(), x_.size())) {
        history_.note(0, numbers_of(x_), numbers_of(r_));
        restart();
    }

    SolverResult run() {
        const double goal = 0.5 * options_.tolerance * history_.source_norm();
        double at_restart = r_.norm();
        bool stopped = false;
        while (!stopped && r_.norm() < diverged * history_.source_norm() &&
               iterations_ < options_.iterations) {
            if (r_.norm() <= goal || !step()) {
                // What the recurrence leaves is not quite what x leaves.
                const auto left = left_of(problem_, numbers_of(x_));
                r_ = Eigen::Map<const Vector>(left.data(), x_.size());
                if (r_.norm() <= goal || !(r_.norm() < (1.0 - 1e-3) * at_restart)) break;
                at_restart = r_.norm();
                restart();
            }
            stopped = !history_.note(iterations_, numbers_of(x_), numbers_of(r_));
        }
        SolverResult result =
            finish(problem_, options_, {x_.begin(), x_.end()}, iterations_, history_);
        result.stopped = stopped;
        return result;
    }

  private:
    void restart() {
        shadow_ = r_;
        rho_ = alpha_ = omega_ = 1.0;
        v_ = p_ = Vector::Zero(x_.size());
    }

    Vector times(const Vector& y) {
        ++iterations_;
        const auto reflected = reflect(problem_, numbers_of(y));
        return y - Eigen::Map<const Vector>(reflected.data(), y.size());
    }

    static bool orthogonal(double product, const Vector& a, const Vector& b) {
        return !(std::abs(product) > 1e-14 * a.norm() * b.norm());
    }

    // False where the method breaks down, or has nothing left to do.
    bool step() {
        const double rho = shadow_.dot(r_);
        if (orthogonal(rho, shadow_, r_)) return false;
        const double beta = rho / rho_ * alpha_ / omega_;
        rho_ = rho;
        p_ = r_ + beta * (p_ - omega_ * v_);
        v_ = times(p_);
        const double along = shadow_.dot(v_);
        if (orthogonal(along, shadow_, v_)) return false;
        alpha_ = rho / along;
        const Vector s = r_ - alpha_ * v_;
        const Vector t = times(s);
        const double square = t.squaredNorm();
        omega_ = square > 0.0 ? t.dot(s) / square : 0.0;
        x_ += alpha_ * p_ + omega_ * s;
        r_ = s - omega_ * t;
        return omega_ != 0.0;
    }

    const LinearProblem& problem_;
    const SolverOptions& options_;
    SolverHistory history_;
    Vector x_, r_, shadow_, v_, p_;
    double rho_ = 1.0, alpha_ = 1.0, omega_ = 1.0;
    std::size_t iterations_ = 0;
};

}  // namespace

SolverResult solve_bicgstab(const LinearProblem& problem, const SolverOptions& options) {
    if (norm_of(problem.source) == 0.0) return dark(problem);
    return BiConjugate(problem, options).run();
}

}  // namespace tyndall::radiosity
