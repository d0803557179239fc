// Exchange areas: what a method takes and gives, and rows kept as a sparse matrix.
#pragma once

#include <atomic>
#include <functional>
#include <span>
#include <vector>

#include "radiosity/elements.h"
#include "radiosity/progress.h"

namespace tyndall::radiosity {

// What every exchange method works on. The elements are the forest's leaves at the time.
struct Discretization {
    const Enclosure& enclosure;
    const Forest& forest;
    const Elements& elements;
};

struct ExchangeOptions {
    std::size_t band = 0;    // whose extinction to use
    std::size_t rays = 256;  // a row
    std::uint64_t seed = 1;
    ProgressCallback progress{};
    std::atomic<std::size_t>* lost_rays =
        nullptr;  // counts rays that hit the walk's step cap: bugs
};

// Receives the rows, in the order asked for: the receiver, the columns (ascending;
// elements.outside() is outside) and their direct exchange areas [m^2].
using RowSink = std::function<void(ElementId, std::span<const std::uint32_t> columns,
                                   std::span<const double> exchange_areas)>;

using ExchangeMethod = void (*)(const Discretization&, std::span<const ElementId> rows,
                                const ExchangeOptions&, const RowSink&);

// Rows in compressed form; row i is [starts[i], starts[i+1]).
struct ExchangeAreas {
    std::vector<std::size_t> starts{0};
    std::vector<std::uint32_t> columns;
    std::vector<double> values;  // [m^2]

    std::size_t rows() const { return starts.size() - 1; }
    std::size_t memory() const {
        return starts.size() * 8 + columns.size() * 4 + values.size() * 8;
    }
};

// All rows of all elements by one method.
ExchangeAreas all_rows(ExchangeMethod method, const Discretization& discretization,
                       const ExchangeOptions& options);

// max_i |Σ_j S_ij − c_i| / c_i, outside counted [-].
double closure_error(const ExchangeAreas& areas, const Elements& elements, std::size_t band);

// Σ_ij |S_ij − S_ji| / Σ_ij S_ij over the elements, outside left out [-].
double reciprocity_error(const ExchangeAreas& areas, const Elements& elements);

}  // namespace tyndall::radiosity
