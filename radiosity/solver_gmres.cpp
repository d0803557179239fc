#include "radiosity/solver_gmres.h"

#include <Eigen/Core>
#include <Eigen/Jacobi>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace tyndall::radiosity {
namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

constexpr Eigen::Index most_steps = 40;

std::span<const double> values_of(const Vector& v) {
    return {v.data(), static_cast<std::size_t>(v.size())};
}

// An orthonormal basis of what k passes reach from a first vector, and the operator in it:
// A V_k = V_{k+1} H_k.
class Arnoldi {
  public:
    Arnoldi(const LinearProblem& problem, const Vector& first)
        : problem_(problem),
          length_(first.norm()),
          v_(first.size(), most_steps + 1),
          received_(first.size(), most_steps),
          h_(Matrix::Zero(most_steps + 1, most_steps)) {
        v_.col(0) = first / length_;
    }

    // One pass. False if the space ends here.
    bool extend() {
        const Vector last = v_.col(steps_);
        const auto received = multiply(problem_.areas, problem_.elements, values_of(last));
        received_.col(steps_) = Eigen::Map<const Vector>(received.data(), last.size());
        Vector w = last;
        for (Eigen::Index i = 0; i < w.size(); ++i)
            w[i] -=
                problem_.scatter_over_capacity(static_cast<std::size_t>(i)) * received_(i, steps_);
        const double before = w.norm();
        // Twice: once leaves rounding behind where w nearly lies in the space.
        for (int turn = 0; turn < 2; ++turn)
            for (Eigen::Index k = 0; k <= steps_; ++k) {
                const double along = v_.col(k).dot(w);
                h_(k, steps_) += along;
                w -= along * v_.col(k);
            }
        const double length = w.norm();
        const bool more = length > 1e-14 * before;
        h_(steps_ + 1, steps_) = more ? length : 0.0;
        v_.col(steps_ + 1) = more ? Vector(w / length) : Vector(Vector::Zero(w.size()));
        ++steps_;
        return more;
    }

    // What leaves least: y of x = x0 + V y, and what it leaves.
    struct Best {
        Vector y, left;
    };
    Best best() const {
        const Eigen::Index k = steps_;
        Vector right = Vector::Zero(k + 1);
        right[0] = length_;
        const auto h = h_.topLeftCorner(k + 1, k);
        const Vector y = h.colPivHouseholderQr().solve(right);
        return {y, v_.leftCols(k + 1) * (right - h * y)};
    }
    Vector change(const Vector& y) const { return v_.leftCols(y.size()) * y; }
    // S V y, of the passes made: no other is needed to know what x receives.
    Vector received(const Vector& y) const { return received_.leftCols(y.size()) * y; }

    bool full() const { return steps_ == most_steps; }

  private:
    const LinearProblem& problem_;
    double length_;
    Matrix v_, received_, h_;
    Eigen::Index steps_ = 0;
};

}  // namespace

SolverResult solve_gmres(const LinearProblem& problem, const SolverOptions& options) {
    if (norm_of(problem.source) == 0.0) return dark(problem);
    SolverHistory history(problem, options);
    const auto n = static_cast<Eigen::Index>(problem.elements.size());
    Vector x = Vector::Zero(n), left = Eigen::Map<const Vector>(problem.source.data(), n);
    Vector received = Vector::Zero(n);  // S x
    const auto product = [&](std::span<const double> of) -> Vector {
        const auto result = multiply(problem.areas, problem.elements, of);
        return Eigen::Map<const Vector>(result.data(), n);
    };
    const auto find_left = [&] {
        const auto rest = left_of(problem, values_of(x), values_of(received));
        left = Eigen::Map<const Vector>(rest.data(), n);
    };
    if (!options.guess.empty()) {
        x = Eigen::Map<const Vector>(options.guess.data(), n);
        received = product(options.guess);
        find_left();
    }
    history.note(0, values_of(x), values_of(left));
    const double goal = 0.5 * options.tolerance * history.source_norm();
    std::size_t iterations = 0;
    bool stopped = false;
    while (left.norm() > goal && iterations < options.iterations && !stopped) {
        const double before = left.norm();
        Arnoldi arnoldi(problem, left);
        Vector y;
        for (bool more = true; more && iterations < options.iterations && !stopped;) {
            more = arnoldi.extend() && !arnoldi.full();
            auto best = arnoldi.best();
            y = std::move(best.y);
            stopped =
                !history.note(++iterations, values_of(x + arnoldi.change(y)), values_of(best.left));
            more = more && best.left.norm() > goal;
        }
        x += arnoldi.change(y);
        received += arnoldi.received(y);
        find_left();
        if (left.norm() > goal) {  // before it goes on: rounding may have added up
            received = product(values_of(x));
            find_left();
        }
        if (!(left.norm() < (1.0 - 1e-3) * before)) break;  // nothing more is to be gained
    }
    SolverResult result = finish(problem, options, {x.begin(), x.end()}, iterations, history,
                                 {received.begin(), received.end()});
    result.stopped = stopped;
    return result;
}

}  // namespace tyndall::radiosity
