#include "radiosity/solver_direct.h"

#include <fmt/format.h>

#include <Eigen/Dense>

#include "mesh/input_error.h"
#include "radiosity/column_shares.h"

namespace tyndall::radiosity {
namespace {

// I − a/c S, with every row spread over the elements that its columns stand for.
Eigen::MatrixXd dense_system(const LinearProblem& problem) {
    const ExchangeAreas& areas = problem.areas;
    const ColumnShares shares(areas, problem.elements);
    const std::size_t n = problem.elements.size();
    const bool linear = !areas.moments.empty();
    Eigen::MatrixXd system =
        Eigen::MatrixXd::Identity(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
    std::vector<double> values(shares.columns());
    std::vector<Direction> moments(linear ? shares.columns() : 0);
    for (std::size_t i = 0; i < n; ++i) {
        std::fill(values.begin(), values.end(), 0.0);
        std::fill(moments.begin(), moments.end(), Direction(0.0));
        for (std::size_t k = areas.starts[i]; k < areas.starts[i + 1]; ++k) {
            values[areas.columns[k]] = areas.value(k);
            if (linear) moments[areas.columns[k]] = Direction(areas.moments[k]);
        }
        const double factor = problem.scatter_over_capacity(i);
        for (std::size_t j = 0; j < n; ++j) {
            double sum = 0.0;
            for (const auto& part : shares.of(j)) {
                sum += part.share * values[part.column];
                if (linear) sum += glm::dot(part.gradient, moments[part.column]);
            }
            system(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) -= factor * sum;
        }
    }
    return system;
}

}  // namespace

void check_direct_size(std::size_t elements) {
    if (elements <= most_direct_elements) return;
    throw mesh::InputError(fmt::format(
        "solver \"direct\" is for up to {} elements, and here are {}: a dense matrix of them would "
        "take {:.1f} GB. Set solve.solver to \"gmres\", or make fewer elements "
        "(solve.element_size, "
        "solve.start = \"base\").",
        most_direct_elements, elements,
        8e-9 * static_cast<double>(elements) * static_cast<double>(elements)));
}

SolverResult solve_direct(const LinearProblem& problem, const SolverOptions& options) {
    check_direct_size(problem.elements.size());
    if (norm_of(problem.source) == 0.0) return dark(problem);
    SolverHistory history(problem, options);
    const auto n = static_cast<Eigen::Index>(problem.elements.size());
    const std::vector<double> nothing(problem.elements.size(), 0.0);
    history.note(0, nothing, problem.source);
    const Eigen::PartialPivLU<Eigen::MatrixXd> factors(dense_system(problem));
    const Eigen::VectorXd x =
        factors.solve(Eigen::Map<const Eigen::VectorXd>(problem.source.data(), n));
    return finish(problem, options, {x.begin(), x.end()}, 1, history);
}

}  // namespace tyndall::radiosity
