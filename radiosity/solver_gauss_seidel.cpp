#include "radiosity/solver_gauss_seidel.h"

#include "radiosity/column_shares.h"

namespace tyndall::radiosity {
namespace {

// x, and what it makes of the columns of rows.
class Gathering {
  public:
    Gathering(const LinearProblem& problem, double over_relaxation)
        : problem_(problem),
          shares_(problem.areas, problem.elements),
          factors_(self_shares(problem, shares_)),
          x_(problem.elements.size(), 0.0) {
        for (double& factor : factors_) factor = over_relaxation * over_itself(factor);
    }

    void sweep() {
        // Anew each time, so that rounding does not add up.
        columns_.assign(shares_.columns(), 0.0);
        gradients_.assign(problem_.areas.moments.empty() ? 0 : shares_.columns(), Direction(0.0));
        for (std::size_t j = 0; j < x_.size(); ++j) spread(j, x_[j]);
        for (std::size_t i = 0; i < x_.size(); ++i) {
            const double left =
                problem_.source[i] + problem_.scatter_over_capacity(i) * received(i) - x_[i];
            const double change = factors_[i] * left;  // (38)
            x_[i] += change;
            spread(i, change);
        }
    }

    const std::vector<double>& x() const { return x_; }

  private:
    double received(std::size_t i) const {
        const ExchangeAreas& areas = problem_.areas;
        double sum = 0.0;
        for (std::size_t k = areas.starts[i]; k < areas.starts[i + 1]; ++k)
            sum += areas.value(k) * columns_[areas.columns[k]];
        for (std::size_t k = areas.starts[i]; !gradients_.empty() && k < areas.starts[i + 1]; ++k)
            sum += glm::dot(Direction(areas.moments[k]), gradients_[areas.columns[k]]);
        return sum;
    }

    void spread(std::size_t j, double change) {
        for (const auto& part : shares_.of(j)) {
            columns_[part.column] += change * part.share;
            if (!gradients_.empty()) gradients_[part.column] += change * part.gradient;
        }
    }

    const LinearProblem& problem_;
    ColumnShares shares_;
    std::vector<double> factors_;  // ω / (1 − a_i S_ii/c_i)
    std::vector<double> x_;
    std::vector<double> columns_;       // values of the rows' columns
    std::vector<Direction> gradients_;  // of these, where rows have moments
};

}  // namespace

SolverResult solve_gauss_seidel(const LinearProblem& problem, const SolverOptions& options) {
    if (norm_of(problem.source) == 0.0) return dark(problem);
    SolverHistory history(problem, options);
    Gathering gathering(problem, options.over_relaxation);
    history.note(0, gathering.x(), problem.source);
    std::size_t iterations = 0;
    bool stopped = false;
    for (double residual = 1.0;
         residual > options.tolerance && residual < diverged && iterations < options.iterations;) {
        gathering.sweep();
        const SolverHistory::Uncounted uncounted(history);
        const std::vector<double> left = left_of(problem, gathering.x());
        residual = norm_of(left) / history.source_norm();
        stopped = !history.note(++iterations, gathering.x(), left);
        if (stopped) break;
    }
    SolverResult result = finish(problem, options, gathering.x(), iterations, history);
    result.stopped = stopped;
    return result;
}

}  // namespace tyndall::radiosity
