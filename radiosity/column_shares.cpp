#include "radiosity/column_shares.h"

#include <algorithm>

namespace tyndall::radiosity {
namespace {

struct PlacedPart {
    std::uint32_t element;
    ColumnShares::Part part;
};

// Of every element, of its value in the gradients around it: g_k = Σ_n w_kn (x_n − x_k).
void add_gradients(const ElementGradients& gradients, std::size_t n,
                   std::vector<PlacedPart>& parts) {
    for (std::uint32_t k = 0; k < n; ++k) {
        const auto neighbours = gradients.neighbours_of(k);
        const auto weights = gradients.weights_of(k);
        Direction own(0.0);
        for (std::size_t m = 0; m < neighbours.size(); ++m) {
            const Direction w(weights[m]);
            own -= w;
            parts.push_back({neighbours[m], {k, 0.0, w}});
        }
        parts.push_back({k, {k, 1.0, own}});
    }
}

void add_levels(const RowLevels& levels, std::size_t n, std::vector<PlacedPart>& parts) {
    for (std::uint32_t i = 0; i < n; ++i) {
        double share = 1.0;
        for (std::uint32_t node = i; node != none; node = levels.parent[node]) {
            parts.push_back({i, {node, share, Direction(0.0)}});
            share *= levels.share[node];
        }
    }
}

}  // namespace

ColumnShares::ColumnShares(const ExchangeAreas& areas, const Elements& elements)
    : columns_(areas.levels.empty() ? elements.size() + 1 : areas.levels.columns()) {
    const std::size_t n = elements.size();
    std::vector<PlacedPart> parts;
    if (!areas.moments.empty()) {
        add_gradients(*areas.gradients, n, parts);
    } else if (!areas.levels.empty()) {
        add_levels(areas.levels, n, parts);
    } else {
        for (std::uint32_t i = 0; i < n; ++i) parts.push_back({i, {i, 1.0, Direction(0.0)}});
    }
    starts_.assign(n + 1, 0);
    for (const auto& placed : parts) ++starts_[placed.element + 1];
    for (std::size_t i = 0; i < n; ++i) starts_[i + 1] += starts_[i];
    parts_.resize(parts.size());
    auto next = starts_;
    for (const auto& placed : parts) parts_[next[placed.element]++] = placed.part;
}

std::vector<double> self_shares(const LinearProblem& problem, const ColumnShares& shares) {
    const ExchangeAreas& areas = problem.areas;
    std::vector<double> result(problem.elements.size());
    for (std::size_t i = 0; i < result.size(); ++i) {
        const auto begin = areas.columns.begin() + static_cast<std::ptrdiff_t>(areas.starts[i]);
        const auto end = areas.columns.begin() + static_cast<std::ptrdiff_t>(areas.starts[i + 1]);
        double sum = 0.0;
        for (const auto& part : shares.of(i)) {
            const auto found = std::lower_bound(begin, end, part.column);
            if (found == end || *found != part.column) continue;
            const auto k = static_cast<std::size_t>(found - areas.columns.begin());
            sum += part.share * areas.value(k);
            if (!areas.moments.empty()) sum += glm::dot(part.gradient, Direction(areas.moments[k]));
        }
        result[i] = problem.scatter_over_capacity(i) * sum;
    }
    return result;
}

double over_itself(double self_share) {
    return self_share < 1.0 - 1e-9 ? 1.0 / (1.0 - self_share) : 1.0;
}

std::vector<double> ends_of_light(const LinearProblem& problem, const ColumnShares& shares) {
    const ExchangeAreas& areas = problem.areas;
    std::vector<double> of_columns(shares.columns(), 0.0);
    std::vector<Direction> of_gradients(areas.moments.empty() ? 0 : shares.columns(),
                                        Direction(0.0));
    for (std::size_t i = 0; i < areas.rows(); ++i) {
        const double absorbed = 1.0 - problem.scatter(i);
        for (std::size_t k = areas.starts[i]; k < areas.starts[i + 1]; ++k) {
            of_columns[areas.columns[k]] += absorbed * areas.value(k);
            if (!of_gradients.empty())
                of_gradients[areas.columns[k]] += absorbed * Direction(areas.moments[k]);
        }
    }
    std::vector<double> result(problem.elements.size());
    for (std::size_t j = 0; j < result.size(); ++j) {
        double sum =
            problem.outside.empty() ? to_outside(areas, problem.elements, j) : problem.outside[j];
        for (const auto& part : shares.of(j)) {
            sum += part.share * of_columns[part.column];
            if (!of_gradients.empty()) sum += glm::dot(part.gradient, of_gradients[part.column]);
        }
        result[j] = sum;
    }
    return result;
}

}  // namespace tyndall::radiosity
