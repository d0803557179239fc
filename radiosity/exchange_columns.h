// Exchange areas by columns: what every element receives of one that shoots.
#pragma once

#include "radiosity/exchange.h"

namespace tyndall::radiosity {

// Column j is [starts[j], starts[j+1]): rows ascending.
struct ExchangeColumns {
    std::vector<std::size_t> starts;
    std::vector<std::uint32_t> rows;
    std::vector<float> values;       // of the rows' entries [m^2]
    std::vector<float> remainders;   // as in ExchangeAreas
    std::vector<glm::vec3> moments;  // as in ExchangeAreas [m^3]
};

// Purpose: the same entries by columns, `columns` of them (ColumnShares). Cost: two passes over the
//   entries; memory: theirs once more.
ExchangeColumns columns_of(const ExchangeAreas& areas, std::size_t columns);

}  // namespace tyndall::radiosity
