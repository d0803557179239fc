#include "radiosity/exchange.h"

#include <algorithm>
#include <cmath>

namespace tyndall::radiosity {

ExchangeAreas all_rows(ExchangeMethod method, const Discretization& discretization,
                       const ExchangeOptions& options) {
    std::vector<ElementId> rows(discretization.elements.size());
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = ElementId(i);
    ExchangeAreas areas;
    method(discretization, rows, options,
           [&](ElementId, std::span<const std::uint32_t> columns, std::span<const double> values) {
               areas.columns.insert(areas.columns.end(), columns.begin(), columns.end());
               areas.values.insert(areas.values.end(), values.begin(), values.end());
               areas.starts.push_back(areas.columns.size());
           });
    return areas;
}

double closure_error(const ExchangeAreas& areas, const Elements& elements, std::size_t band) {
    double worst = 0.0;
    for (std::size_t i = 0; i < areas.rows(); ++i) {
        const double capacity = elements.capacity[i * elements.bands + band];
        if (!(capacity > 0.0)) continue;
        double sum = 0.0;
        for (std::size_t k = areas.starts[i]; k < areas.starts[i + 1]; ++k) sum += areas.values[k];
        worst = std::max(worst, std::abs(sum - capacity) / capacity);
    }
    return worst;
}

double reciprocity_error(const ExchangeAreas& areas, const Elements& elements) {
    const auto entry = [&](std::size_t i, std::uint32_t j) {
        const auto begin = areas.columns.begin() + static_cast<std::ptrdiff_t>(areas.starts[i]);
        const auto end = areas.columns.begin() + static_cast<std::ptrdiff_t>(areas.starts[i + 1]);
        const auto found = std::lower_bound(begin, end, j);
        return found != end && *found == j
                   ? areas.values[static_cast<std::size_t>(found - areas.columns.begin())]
                   : 0.0;
    };
    double difference = 0.0, total = 0.0;
    for (std::size_t i = 0; i < areas.rows(); ++i)
        for (std::size_t k = areas.starts[i]; k < areas.starts[i + 1]; ++k) {
            const std::uint32_t j = areas.columns[k];
            if (j == elements.outside()) continue;
            const double back = entry(j, static_cast<std::uint32_t>(i));
            // A pair that is seen from one end only is met once here but twice in the sum.
            difference += std::abs(areas.values[k] - back) * (back > 0.0 ? 1.0 : 2.0);
            total += areas.values[k];
        }
    return total > 0.0 ? difference / total : 0.0;
}

}  // namespace tyndall::radiosity
