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
          h_(Matrix::Zero(most_steps + 1, most_steps)) {
        v_.col(0) = first / length_;
    }

    // One pass. False if the space ends here.
    bool extend() {
        const Vector last = v_.col(steps_);
        const auto reflected = reflect(problem_, values_of(last));
        Vector w = last - Eigen::Map<const Vector>(reflected.data(), last.size());
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
        Vector change, left;
    };
    Best best() const {
        const Eigen::Index k = steps_;
        Vector right = Vector::Zero(k + 1);
        right[0] = length_;
        const auto h = h_.topLeftCorner(k + 1, k);
        const Vector y = h.colPivHouseholderQr().solve(right);
        return {v_.leftCols(k) * y, v_.leftCols(k + 1) * (right - h * y)};
    }

    bool full() const { return steps_ == most_steps; }

  private:
    const LinearProblem& problem_;
    double length_;
    Matrix v_, h_;
    Eigen::Index steps_ = 0;
};

}  // namespace

SolverResult solve_gmres(const LinearProblem& problem, const SolverOptions& options) {
    if (norm_of(problem.source) == 0.0) return dark(problem);
    SolverHistory history(problem, options);
    const auto n = static_cast<Eigen::Index>(problem.elements.size());
    Vector x = Vector::Zero(n), left = Eigen::Map<const Vector>(problem.source.data(), n);
    std::vector<double> received;  // S x
    const auto look_at = [&] {
        received = multiply(problem.areas, problem.elements, values_of(x));
        const auto rest = left_of(problem, values_of(x), received);
        left = Eigen::Map<const Vector>(rest.data(), n);
    };
    if (!options.guess.empty()) {
        x = Eigen::Map<const Vector>(options.guess.data(), n);
        look_at();
    }
    history.note(0, values_of(x), values_of(left));
    const double goal = 0.5 * options.tolerance * history.source_norm();
    std::size_t iterations = 0;
    bool stopped = false;
    while (left.norm() > goal && iterations < options.iterations && !stopped) {
        const double before = left.norm();
        Arnoldi arnoldi(problem, left);
        Vector change;
        for (bool more = true; more && iterations < options.iterations && !stopped;) {
            more = arnoldi.extend() && !arnoldi.full();
            auto best = arnoldi.best();
            change = std::move(best.change);
            stopped = !history.note(++iterations, values_of(x + change), values_of(best.left));
            more = more && best.left.norm() > goal;
        }
        x += change;
        look_at();
        if (!(left.norm() < (1.0 - 1e-3) * before)) break;  // nothing more is to be gained
    }
    SolverResult result =
        finish(problem, options, {x.begin(), x.end()}, iterations, history, std::move(received));
    result.stopped = stopped;
    return result;
}

}  // namespace tyndall::radiosity
