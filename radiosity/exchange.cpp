#include "radiosity/exchange.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "radiosity/smoothing.h"

namespace tyndall::radiosity {
namespace {

// Appends a row in single precision: each entry takes over what rounding left of the one before,
// so that rows still close.
void append_rounded(std::span<const double> row, std::vector<float>& values) {
    double left = 0.0;
    for (const double value : row) {
        const auto rounded = static_cast<float>(std::max(0.0, value + left));
        left += value - static_cast<double>(rounded);
        values.push_back(rounded);
    }
}

// Space for all rows, by the mean length of some: growth would copy, and hold both copies.
void reserve(ExchangeAreas& areas, ExchangeMethod method, const Discretization& d,
             ExchangeOptions options) {
    constexpr std::size_t sample = 256;
    const std::size_t count = d.elements.size();
    areas.starts.reserve(count + 1);
    if (count < 16 * sample) return;
    std::vector<ElementId> rows;
    for (std::size_t k = 0; k < sample; ++k) rows.push_back(ElementId(k * count / sample));
    options.progress = {};
    options.lost_rays = nullptr;
    std::size_t entries = 0;
    method(d, rows, options, [&](const Row& row) { entries += row.columns.size(); });
    // A tenth more: memory that is not written to is not taken.
    const std::size_t all = entries * count / sample;
    areas.columns.reserve(all + all / 10);
    areas.values.reserve(all + all / 10);
    if (options.radiance == Radiance::linear) areas.moments.reserve(all + all / 10);
    if (options.settings.smoothing != Smoothing::none) areas.remainders.reserve(all + all / 10);
}

// Adds Σ_j M_ij · g_j to the sums of all rows, given g one an element; outside has none.
template <class Vector>
void add_moments(const ExchangeAreas& areas, std::vector<Vector> gradients,
                 std::vector<double>& sums) {
    gradients.emplace_back(0.0f);
    tbb::parallel_for(std::size_t(0), sums.size(), [&](std::size_t i) {
        double sum = sums[i];
        for (std::size_t k = areas.starts[i]; k < areas.starts[i + 1]; ++k)
            sum += glm::dot(Vector(areas.moments[k]), gradients[areas.columns[k]]);
        sums[i] = sum;
    });
}

}  // namespace

void append(ExchangeAreas& areas, const Row& row, Precision precision) {
    areas.columns.insert(areas.columns.end(), row.columns.begin(), row.columns.end());
    if (precision == Precision::single_sums) {
        append_rounded(row.exchange_areas, areas.values);
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
    const Smoothing smoothing = options.settings.smoothing;
    check_smoothing(smoothing, options.detail);
    std::vector<ElementId> rows(discretization.elements.size());
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = ElementId(i);
    ExchangeAreas areas;
    ExchangeOptions chosen = options;
    if (options.detail > 0.0 || !discretization.elements.member_starts.empty())
        chosen.radiance = Radiance::constant;
    if (chosen.radiance == Radiance::linear)
        areas.gradients = std::make_shared<const ElementGradients>(
            discretization.enclosure, discretization.forest, discretization.elements);
    if (options.detail > 0.0 && discretization.elements.member_starts.empty()) {
        areas.levels = options.levels
                           ? *options.levels
                           : make_row_levels(discretization.enclosure, discretization.forest,
                                             discretization.elements);
        chosen.levels = &areas.levels;
    }
    reserve(areas, method, discretization, chosen);
    method(discretization, rows, chosen, [&](const Row& row) {
        append(areas, row,
               smoothing == Smoothing::none ? Precision::single_sums : Precision::doubled);
    });
    if (smoothing == Smoothing::none) return areas;
    return smooth(std::move(areas), discretization.elements, options.band, smoothing);
}

std::vector<double> multiply(const ExchangeAreas& areas, const Elements& elements,
                             std::span<const double> x) {
    // Outside has the value 0: no entry needs to ask.
    std::vector<double> values;
    if (areas.levels.empty()) {
        values.assign(x.begin(), x.end());
        values.resize(elements.size() + 1, 0.0);
    } else {
        values = areas.levels.pull(x);
    }
    const bool remainders = !areas.remainders.empty();
    std::vector<double> result(areas.rows());
    tbb::parallel_for(std::size_t(0), result.size(), [&](std::size_t i) {
        double sum = 0.0;
        for (std::size_t k = areas.starts[i]; k < areas.starts[i + 1]; ++k)
            sum += static_cast<double>(areas.values[k]) * values[areas.columns[k]];
        for (std::size_t k = areas.starts[i]; remainders && k < areas.starts[i + 1]; ++k)
            sum += static_cast<double>(areas.remainders[k]) * values[areas.columns[k]];
        result[i] = sum;
    });
    // Rows in double precision are for solutions to as many digits.
    if (!areas.moments.empty() && remainders)
        add_moments(areas, areas.gradients->unrounded(x), result);
    else if (!areas.moments.empty())
        add_moments(areas, areas.gradients->of(x), result);
    return result;
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
