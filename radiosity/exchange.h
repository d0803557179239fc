// Exchange areas: what a method takes and gives, and rows kept as a sparse matrix.
#pragma once

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "radiosity/elements.h"
#include "radiosity/gradients.h"
#include "radiosity/large_vector.h"
#include "radiosity/options.h"
#include "radiosity/progress.h"
#include "radiosity/row_levels.h"

namespace tyndall::radiosity {

// What every exchange method works on. The elements are the forest's leaves at the time.
struct Discretization {
    const Enclosure& enclosure;
    const Forest& forest;
    const Elements& elements;
};

// Which part of their ways rays make rows of.
enum class RowLegs {
    all,
    in_mirrors,  // what reaches patches by way of mirrors, as a part of the same rows
};

struct ExchangeOptions {
    std::size_t band = 0;    // whose extinction to use
    std::size_t rays = 256;  // a row
    std::uint64_t seed = 1;
    ExchangeSettings settings{};
    std::span<const ElementId> columns{};  // pairs with others need not be computed; empty: all are
    double detail = 0.0;  // theta: a zone whose longest edge is h stands for the elements below it
                          // from distance t on where h ≤ theta t sqrt(4 pi / rays), a patch from
                          // eight times that; 0: never [-]
    Radiance radiance = Radiance::constant;  // what elements hold; linear: rows have first moments
    const RowLevels* levels = nullptr;  // the nodes' columns; `all_rows` makes them if there is
                                        // detail
    ProgressCallback progress{};
    std::atomic<std::size_t>* lost_rays =
        nullptr;  // counts rays that hit the walk's step cap: bugs
    RowLegs legs = RowLegs::all;
};

// A row: what one receiver exchanges with every element that it exchanges anything with.
struct Row {
    ElementId receiver;
    // Ascending; elements.outside() is outside, coarser nodes come after it.
    std::span<const std::uint32_t> columns;
    std::span<const double> exchange_areas;  // S_ij [m^2]
    // S_ij with x' − c_j in the integral, x' the points of j and c_j its centroid: what a gradient
    // in j adds. Empty where elements hold constants [m^3].
    std::span<const Direction> moments;
};

// Receives the rows, in the order asked for.
using RowSink = std::function<void(const Row&)>;

using ExchangeMethod = void (*)(const Discretization&, std::span<const ElementId> rows,
                                const ExchangeOptions&, const RowSink&);

// Rows of several bands made together, each into its sink.
using BandsExchangeMethod = void (*)(const Discretization&, std::span<const ElementId> rows,
                                     const ExchangeOptions&, std::span<const std::size_t> bands,
                                     std::span<const RowSink> sinks);

// What smoothing (smoothing.h) did to rows, and what it had to mend.
struct SmoothingReport {
    Smoothing method = Smoothing::none;
    double raw_closure_error = 0.0;      // of the rows as they were made [-]
    double raw_reciprocity_error = 0.0;  // the same [-]
    // Σ_j |S'_ij − S_ij| / c_i: how far rows were moved, the farthest and the mean of all [-].
    double moved_max = 0.0, moved_mean = 0.0;
    std::size_t clamped = 0;     // entries that least squares would make negative: they are 0
    std::size_t iterations = 0;  // passes over the entries
    bool converged = true;       // rows close as asked
};

// Rows in compressed form; row i is [starts[i], starts[i+1]).
struct ExchangeAreas {
    std::vector<std::size_t> starts{0};
    LargeVector<std::uint32_t> columns;
    LargeVector<float> values;       // so rounded that a row keeps its sum [m^2]
    LargeVector<float> remainders;   // what that leaves of values in double precision: smoothed
                                     // rows have them; empty: it is not kept [m^2]
    LargeVector<glm::vec3> moments;  // of the entries; empty: elements hold constants [m^3]
    RowLevels levels;                // what columns beyond outside stand for; empty: there are none
    std::shared_ptr<const ElementGradients> gradients;  // that the moments multiply
    std::optional<SmoothingReport> smoothing;           // of rows that were smoothed

    double value(std::size_t k) const {
        const auto value = static_cast<double>(values[k]);
        return remainders.empty() ? value : value + static_cast<double>(remainders[k]);
    }
    std::size_t rows() const { return starts.size() - 1; }
    std::size_t memory() const {
        return starts.size() * 8 + columns.size() * 4 + values.size() * 4 + remainders.size() * 4 +
               moments.size() * sizeof(glm::vec3) + levels.memory() +
               (gradients ? gradients->memory() : 0);
    }
};

// A row's entries, one after the other, in single precision: each takes over what rounding left of
// the one before, so that rows still close.
class RowRounding {
  public:
    // The next entry [m^2].
    float operator()(double value) {
        const auto rounded = static_cast<float>(std::max(0.0, value + left_));
        left_ += value - static_cast<double>(rounded);
        return rounded;
    }

  private:
    double left_ = 0.0;
};

// How rows are kept: in single precision with their sums, or with the first 48 bits of a double's
// 53 (values and remainders), which takes 4 bytes more an entry.
enum class Precision { single_sums, doubled };

// Adds a row to those there are, all in one precision.
void append(ExchangeAreas& areas, const Row& row, Precision precision);

// Σ_j S_ij x_j of every row, outside left out, for x given an element; with moments M for x linear
// in each element, its gradients g those of `gradients`: Σ_j S_ij x_j + M_ij · g_j (31). Cost: one
// pass over the entries, in parallel.
std::vector<double> multiply(const ExchangeAreas& areas, const Elements& elements,
                             std::span<const double> x);

// The entry of a row in a column [m^2]. Cost: O(log entries).
double entry(const ExchangeAreas& areas, std::size_t row, std::uint32_t column);

// S_i,out of a row [m^2]. Cost: O(log entries).
double to_outside(const ExchangeAreas& areas, const Elements& elements, std::size_t row);

// All rows of all elements by one method; with options.detail also the levels above the elements,
// where these are leaves of the forest, and with Radiance::linear moments; not both: a far node's
// mean is all that level of detail keeps of it. With settings.smoothing the rows are smoothed when
// all are there. Memory: that of the result, and a batch of rows.
// Errors: mesh::InputError for smoothing with level of detail.
ExchangeAreas all_rows(ExchangeMethod method, const Discretization& discretization,
                       const ExchangeOptions& options);

// The same for each of several bands; `options.band` is not read.
std::vector<ExchangeAreas> all_rows(BandsExchangeMethod method,
                                    const Discretization& discretization,
                                    const ExchangeOptions& options,
                                    std::span<const std::size_t> bands);

// max_i |Σ_j S_ij − c_i| / c_i, outside counted [-].
double closure_error(const ExchangeAreas& areas, const Elements& elements, std::size_t band);

// Σ_ij |S_ij − S_ji| / Σ_ij S_ij over the elements, outside left out [-]. Where columns stand for
// several elements: estimated, from one of them drawn by its share. From 64 rows, or up to twice as
// many; of rows of more than 511 entries from 256, or up to twice as many.
double reciprocity_error(const ExchangeAreas& areas, const Elements& elements);

}  // namespace tyndall::radiosity
