#include "radiosity/exchange_columns.h"

namespace tyndall::radiosity {

ExchangeColumns columns_of(const ExchangeAreas& areas, std::size_t columns) {
    ExchangeColumns result;
    result.starts.assign(columns + 1, 0);
    for (const auto column : areas.columns) ++result.starts[column + 1];
    for (std::size_t j = 0; j < columns; ++j) result.starts[j + 1] += result.starts[j];
    result.rows.resize(areas.columns.size());
    result.values.resize(areas.values.size());
    result.remainders.resize(areas.remainders.size());
    result.moments.resize(areas.moments.size());
    auto next = result.starts;
    for (std::size_t i = 0; i < areas.rows(); ++i)
        for (std::size_t k = areas.starts[i]; k < areas.starts[i + 1]; ++k) {
            const std::size_t at = next[areas.columns[k]]++;
            result.rows[at] = static_cast<std::uint32_t>(i);
            result.values[at] = areas.values[k];
            if (!areas.remainders.empty()) result.remainders[at] = areas.remainders[k];
            if (!areas.moments.empty()) result.moments[at] = areas.moments[k];
        }
    return result;
}

}  // namespace tyndall::radiosity
