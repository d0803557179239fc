#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <unsupported/Eigen/IterativeSolvers>

#include "radiosity/solver.h"

namespace tyndall::radiosity {
class SystemMatrix;
}

// Eigen's matrix-free hook: the operator I − (a/c) S acts without being stored a second time.
namespace Eigen::internal {
template <>
struct traits<tyndall::radiosity::SystemMatrix> : traits<SparseMatrix<double>> {};
}  // namespace Eigen::internal

namespace tyndall::radiosity {

class SystemMatrix : public Eigen::EigenBase<SystemMatrix> {
  public:
    using Scalar = double;
    using RealScalar = double;
    using StorageIndex = int;
    enum {
        ColsAtCompileTime = Eigen::Dynamic,
        MaxColsAtCompileTime = Eigen::Dynamic,
        IsRowMajor = false
    };

    explicit SystemMatrix(const LinearProblem& problem) : problem_(problem) {}
    Eigen::Index rows() const { return static_cast<Eigen::Index>(problem_.elements.size()); }
    Eigen::Index cols() const { return rows(); }
    template <class Rhs>
    Eigen::Product<SystemMatrix, Rhs, Eigen::AliasFreeProduct> operator*(
        const Eigen::MatrixBase<Rhs>& x) const {
        return {*this, x.derived()};
    }
    const LinearProblem& problem() const { return problem_; }

  private:
    const LinearProblem& problem_;
};

std::vector<double> reflect(const LinearProblem& problem, std::span<const double> radiance) {
    const Elements& e = problem.elements;
    std::vector<double> result = multiply(problem.areas, e, radiance);
    for (std::size_t i = 0; i < e.size(); ++i) {
        const double capacity = e.capacity[i * e.bands + problem.band];
        result[i] =
            capacity > 0.0 ? e.scatter[i * e.bands + problem.band] * result[i] / capacity : 0.0;
    }
    return result;
}

}  // namespace tyndall::radiosity

namespace Eigen::internal {
template <class Rhs>
struct generic_product_impl<tyndall::radiosity::SystemMatrix, Rhs, SparseShape, DenseShape,
                            GemvProduct>
    : generic_product_impl_base<tyndall::radiosity::SystemMatrix, Rhs,
                                generic_product_impl<tyndall::radiosity::SystemMatrix, Rhs>> {
    template <class Dest>
    static void scaleAndAddTo(Dest& dest, const tyndall::radiosity::SystemMatrix& matrix,
                              const Rhs& rhs, const double& alpha) {
        const Eigen::VectorXd x = rhs;
        const auto reflected = tyndall::radiosity::reflect(
            matrix.problem(), {x.data(), static_cast<std::size_t>(x.size())});
        for (Eigen::Index i = 0; i < x.size(); ++i)
            dest[i] += alpha * (x[i] - reflected[static_cast<std::size_t>(i)]);
    }
};
}  // namespace Eigen::internal

namespace tyndall::radiosity {

SolverResult solve_gmres(const LinearProblem& problem, const SolverOptions& options) {
    const std::size_t n = problem.elements.size();
    SolverResult result;
    const Eigen::Map<const Eigen::VectorXd> source(problem.source.data(),
                                                   static_cast<Eigen::Index>(n));
    result.radiance.assign(n, 0.0);
    if (source.norm() == 0.0) {
        result.converged = true;
        return result;
    }
    const SystemMatrix matrix(problem);
    Eigen::GMRES<SystemMatrix, Eigen::IdentityPreconditioner> gmres;
    gmres.set_restart(40);
    gmres.setTolerance(0.5 * options.tolerance);
    gmres.setMaxIterations(static_cast<Eigen::Index>(options.iterations));
    gmres.compute(matrix);
    const Eigen::VectorXd x = gmres.solve(source);
    std::copy(x.begin(), x.end(), result.radiance.begin());
    result.iterations = static_cast<std::size_t>(gmres.iterations());

    const auto reflected = reflect(problem, result.radiance);
    double square = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        const double left = problem.source[i] + reflected[i] - result.radiance[i];
        square += left * left;
    }
    result.residual = std::sqrt(square) / source.norm();
    result.converged = result.residual <= options.tolerance;
    return result;
}

}  // namespace tyndall::radiosity
