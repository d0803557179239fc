// Exchange areas: what a method takes and gives, and rows kept as a sparse matrix.
#pragma once

#include <atomic>
#include <functional>
#include <span>
#include <vector>

#include "radiosity/elements.h"
#include "radiosity/progress.h"
#include "radiosity/row_levels.h"

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
    double detail = 0.0;  // theta: a zone whose longest edge is h stands for the elements below it
                          // from distance t on where h ≤ theta t sqrt(4 pi / rays), a patch from
                          // eight times that; 0: never [-]
    const RowLevels* levels = nullptr;  // the nodes' columns; `all_rows` makes them if there is
                                        // detail
    ProgressCallback progress{};
    std::atomic<std::size_t>* lost_rays =
        nullptr;  // counts rays that hit the walk's step cap: bugs
};

// Receives the rows, in the order asked for: the receiver, the columns (ascending;
// elements.outside() is outside, coarser nodes come after it) and their direct exchange areas
// [m^2].
using RowSink = std::function<void(ElementId, std::span<const std::uint32_t> columns,
                                   std::span<const double> exchange_areas)>;

using ExchangeMethod = void (*)(const Discretization&, std::span<const ElementId> rows,
                                const ExchangeOptions&, const RowSink&);

// Rows in compressed form; row i is [starts[i], starts[i+1]).
struct ExchangeAreas {
    std::vector<std::size_t> starts{0};
    std::vector<std::uint32_t> columns;
    std::vector<float> values;  // so rounded that a row keeps its sum [m^2]
    RowLevels levels;           // what columns beyond outside stand for; empty: there are none

    std::size_t rows() const { return starts.size() - 1; }
    std::size_t memory() const {
        return starts.size() * 8 + columns.size() * 4 + values.size() * 4 + levels.memory();
    }
};

// Σ_j S_ij x_j of every row, outside left out, for x given an element. Cost: one pass over the
// entries, in parallel.
std::vector<double> multiply(const ExchangeAreas& areas, const Elements& elements,
                             std::span<const double> x);

// The entry of a row in a column [m^2]. Cost: O(log entries).
double entry(const ExchangeAreas& areas, std::size_t row, std::uint32_t column);

// S_i,out of a row [m^2]. Cost: O(log entries).
double to_outside(const ExchangeAreas& areas, const Elements& elements, std::size_t row);

// All rows of all elements by one method; with options.detail also the levels above the elements,
// where these are leaves of the forest. Memory: that of the result, and a batch of rows.
ExchangeAreas all_rows(ExchangeMethod method, const Discretization& discretization,
                       const ExchangeOptions& options);

// max_i |Σ_j S_ij − c_i| / c_i, outside counted [-].
double closure_error(const ExchangeAreas& areas, const Elements& elements, std::size_t band);

// Σ_ij |S_ij − S_ji| / Σ_ij S_ij over the elements, outside left out [-]. Where columns stand for
// several elements: estimated, from one of them drawn by its share, and from 4096 rows at most.
double reciprocity_error(const ExchangeAreas& areas, const Elements& elements);

}  // namespace tyndall::radiosity
