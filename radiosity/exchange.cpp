#include "radiosity/exchange.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "radiosity/smoothing.h"

namespace tyndall::radiosity {
namespace {

// make(rows, options, sinks) of a method.
using MakeRows = std::function<void(std::span<const ElementId>, const ExchangeOptions&,
                                    std::span<const RowSink>)>;

// Space for all rows, by the mean length of some: growth would copy, and hold both copies.
void reserve(std::vector<ExchangeAreas>& areas, const MakeRows& make, std::size_t count,
             ExchangeOptions options) {
    constexpr std::size_t sample = 256;
    for (ExchangeAreas& one : areas) one.starts.reserve(count + 1);
    if (count < 16 * sample) return;
    std::vector<ElementId> rows;
    for (std::size_t k = 0; k < sample; ++k) rows.push_back(ElementId(k * count / sample));
    options.progress = {};
    options.lost_rays = nullptr;
    std::vector<std::size_t> entries(areas.size(), 0);
    std::vector<RowSink> sinks;
    for (std::size_t& sum : entries)
        sinks.push_back([&sum](const Row& row) { sum += row.columns.size(); });
    make(rows, options, sinks);
    for (std::size_t a = 0; a < areas.size(); ++a) {
        // A tenth more: memory that is not written to is not taken.
        const std::size_t all = entries[a] * count / sample;
        areas[a].columns.reserve(all + all / 10);
        areas[a].values.reserve(all + all / 10);
        if (options.radiance == Radiance::linear) areas[a].moments.reserve(all + all / 10);
        if (options.settings.smoothing != Smoothing::none)
            areas[a].remainders.reserve(all + all / 10);
    }
}

std::vector<ExchangeAreas> make_all_rows(const MakeRows& make, const Discretization& d,
                                         const ExchangeOptions& options,
                                         std::span<const std::size_t> bands) {
    const Smoothing smoothing = options.settings.smoothing;
    check_smoothing(smoothing, options.detail);
    std::vector<ElementId> rows(d.elements.size());
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = ElementId(i);
    std::vector<ExchangeAreas> areas(bands.size());
    ExchangeOptions chosen = options;
    if (options.detail > 0.0 || !d.elements.member_starts.empty())
        chosen.radiance = Radiance::constant;
    if (chosen.radiance == Radiance::linear) {
        const auto gradients =
            std::make_shared<const ElementGradients>(d.enclosure, d.forest, d.elements);
        for (ExchangeAreas& one : areas) one.gradients = gradients;
    }
    if (options.detail > 0.0 && d.elements.member_starts.empty()) {
        const RowLevels levels =
            options.levels ? *options.levels : make_row_levels(d.enclosure, d.forest, d.elements);
        for (ExchangeAreas& one : areas) one.levels = levels;
        chosen.levels = &areas.front().levels;
    }
    reserve(areas, make, rows.size(), chosen);
    std::vector<RowSink> sinks;
    for (ExchangeAreas& one : areas)
        sinks.push_back([&one, smoothing](const Row& row) {
            append(one, row,
                   smoothing == Smoothing::none ? Precision::single_sums : Precision::doubled);
        });
    make(rows, chosen, sinks);
    for (std::size_t k = 0; k < bands.size() && smoothing != Smoothing::none; ++k)
        areas[k] = smooth(std::move(areas[k]), d.elements, bands[k], smoothing);
    return areas;
}

// Σ_k term(k), in four sums side by side: an addition need not wait for the one before.
template <class Term>
double sum_of(std::size_t begin, std::size_t end, Term&& term) {
    std::array<double, 4> sums{};
    std::size_t k = begin;
    for (; k + 4 <= end; k += 4)
        for (std::size_t lane = 0; lane < 4; ++lane) sums[lane] += term(k + lane);
    for (; k < end; ++k) sums[0] += term(k);
    return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

// One sum a row, of term(k) of its entries k.
template <class Term>
std::vector<double> sums_of_rows(const ExchangeAreas& areas, Term&& term) {
    std::vector<double> sums(areas.rows());
    tbb::parallel_for(std::size_t(0), sums.size(), [&](std::size_t i) {
        sums[i] = sum_of(areas.starts[i], areas.starts[i + 1], term);
    });
    return sums;
}

// What a column holds, with its gradient: side by side, since an entry needs both.
template <class Vector>
struct Held {
    double x = 0.0;
    Vector gradient{0.0f};
};

// Σ_j S_ij x_j + M_ij · g_j of every row; outside has the last column and holds nothing.
template <class Vector>
std::vector<double> multiply_linear(const ExchangeAreas& areas, std::span<const double> x,
                                    const std::vector<Vector>& gradients) {
    std::vector<Held<Vector>> held(x.size() + 1);
    for (std::size_t i = 0; i < x.size(); ++i) held[i] = {x[i], gradients[i]};
    const auto term = [&](double area, std::size_t k) {
        const Held<Vector>& at = held[areas.columns[k]];
        return area * at.x + static_cast<double>(glm::dot(Vector(areas.moments[k]), at.gradient));
    };
    if (areas.remainders.empty())
        return sums_of_rows(
            areas, [&](std::size_t k) { return term(static_cast<double>(areas.values[k]), k); });
    return sums_of_rows(areas, [&](std::size_t k) { return term(areas.value(k), k); });
}

}  // namespace

void append(ExchangeAreas& areas, const Row& row, Precision precision) {
    areas.columns.insert(areas.columns.end(), row.columns.begin(), row.columns.end());
    if (precision == Precision::single_sums) {
        RowRounding rounded;
        for (const double value : row.exchange_areas) areas.values.push_back(rounded(value));
    } else {
        for (const double value : row.exchange_areas) {
            areas.values.push_back(static_cast<float>(value));
            areas.remainders.push_back(
                static_cast<float>(value - static_cast<double>(areas.values.back())));
        }
    }
    areas.moments.insert(areas.moments.end(), row.moments.begin(), row.moments.end());
    areas.starts.push_back(areas.columns.size());
}

ExchangeAreas all_rows(ExchangeMethod method, const Discretization& discretization,
                       const ExchangeOptions& options) {
    const auto make = [&](std::span<const ElementId> rows, const ExchangeOptions& chosen,
                          std::span<const RowSink> sinks) {
        method(discretization, rows, chosen, sinks.front());
    };
    return std::move(
        make_all_rows(make, discretization, options, std::span(&options.band, 1)).front());
}

std::vector<ExchangeAreas> all_rows(BandsExchangeMethod method,
                                    const Discretization& discretization,
                                    const ExchangeOptions& options,
                                    std::span<const std::size_t> bands) {
    const auto make = [&](std::span<const ElementId> rows, const ExchangeOptions& chosen,
                          std::span<const RowSink> sinks) {
        method(discretization, rows, chosen, bands, sinks);
    };
    return make_all_rows(make, discretization, options, bands);
}

std::vector<double> multiply(const ExchangeAreas& areas, const Elements& elements,
                             std::span<const double> x) {
    // Rows in double precision are for solutions to as many digits.
    if (!areas.moments.empty() && !areas.remainders.empty())
        return multiply_linear(areas, x, areas.gradients->unrounded(x));
    if (!areas.moments.empty()) return multiply_linear(areas, x, areas.gradients->of(x));
    // Outside has the value 0: no entry needs to ask.
    std::vector<double> values;
    if (areas.levels.empty()) {
        values.assign(x.begin(), x.end());
        values.resize(elements.size() + 1, 0.0);
    } else {
        values = areas.levels.pull(x);
    }
    if (areas.remainders.empty())
        return sums_of_rows(areas, [&](std::size_t k) {
            return static_cast<double>(areas.values[k]) * values[areas.columns[k]];
        });
    return sums_of_rows(areas,
                        [&](std::size_t k) { return areas.value(k) * values[areas.columns[k]]; });
}

double entry(const ExchangeAreas& areas, std::size_t row, std::uint32_t column) {
    const auto begin = areas.columns.begin() + static_cast<std::ptrdiff_t>(areas.starts[row]);
    const auto end = areas.columns.begin() + static_cast<std::ptrdiff_t>(areas.starts[row + 1]);
    const auto found = std::lower_bound(begin, end, column);
    return found != end && *found == column
               ? areas.value(static_cast<std::size_t>(found - areas.columns.begin()))
               : 0.0;
}

double to_outside(const ExchangeAreas& areas, const Elements& elements, std::size_t row) {
    return entry(areas, row, static_cast<std::uint32_t>(elements.outside()));
}

double closure_error(const ExchangeAreas& areas, const Elements& elements, std::size_t band) {
    double worst = 0.0;
    for (std::size_t i = 0; i < areas.rows(); ++i) {
        const double capacity = elements.capacity[i * elements.bands + band];
        if (!(capacity > 0.0)) continue;
        double sum = 0.0;
        for (std::size_t k = areas.starts[i]; k < areas.starts[i + 1]; ++k) sum += areas.value(k);
        worst = std::max(worst, std::abs(sum - capacity) / capacity);
    }
    return worst;
}

}  // namespace tyndall::radiosity
