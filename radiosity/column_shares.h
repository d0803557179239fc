// What an element's value counts in the columns of rows: in its own, in those of the nodes above
// it, and in the gradients of its neighbours.
#pragma once

#include <span>
#include <vector>

#include "radiosity/solver.h"

namespace tyndall::radiosity {

// Σ_j S_ij x_j of rows as they are kept (levels above the elements, moments that multiply
// gradients) is Σ_j x_j Σ_p (share_p S_i,column(p) + gradient_p · M_i,column(p)), p the parts of j.
// Solvers that change one x at a time, or need the system's own entries, work with these. In double
// precision.
class ColumnShares {
  public:
    struct Part {
        std::uint32_t column;
        double share;        // of the column's value, per x [-]
        Direction gradient;  // of the column's gradient, per x [1/m]
    };

    // Cost: O(elements × neighbours or levels).
    ColumnShares(const ExchangeAreas& areas, const Elements& elements);

    std::span<const Part> of(std::size_t element) const {
        return std::span(parts_).subspan(starts_[element], starts_[element + 1] - starts_[element]);
    }
    std::size_t columns() const { return columns_; }

  private:
    std::vector<std::size_t> starts_;
    std::vector<Part> parts_;
    std::size_t columns_;
};

// a_i/c_i times the system's own entry S_ii: what an element sends to itself of what it sends, for
// every element [-]. Cost: O(elements × parts × log entries).
std::vector<double> self_shares(const LinearProblem& problem, const ColumnShares& shares);

// The factor 1 / (1 − self share); 1 where an element keeps all that it sends.
double over_itself(double self_share);

// t_j = Σ_i (1 − a_i) S_ij + S_j,out: of x_j, what ends in absorption and outside [m^2]. Cost: one
// pass over the entries.
std::vector<double> ends_of_light(const LinearProblem& problem, const ColumnShares& shares);

}  // namespace tyndall::radiosity
