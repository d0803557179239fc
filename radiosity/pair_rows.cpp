#include "radiosity/pair_rows.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <numeric>
#include <unordered_map>

#include "mesh/input_error.h"

namespace tyndall::radiosity {
namespace {

constexpr std::size_t most_elements = 5000;

struct Pair {
    std::uint32_t i, j;
    auto operator<=>(const Pair&) const = default;
};

Pair ordered(std::uint32_t a, std::uint32_t b) {
    return {std::min(a, b), std::max(a, b)};
}

std::vector<std::uint32_t> columns_of(const Discretization& d, const ExchangeOptions& options,
                                      bool lacking) {
    const auto outside = static_cast<std::uint32_t>(d.elements.outside());
    std::vector<std::uint32_t> columns;
    for (const ElementId id : options.columns) columns.push_back(id.value);
    const bool wants_outside =
        columns.empty() || std::ranges::find(columns, outside) != columns.end();
    if (columns.empty() || (lacking && wants_outside)) {
        columns.resize(outside + 1);
        std::iota(columns.begin(), columns.end(), 0u);
    }
    std::ranges::sort(columns);
    if (!d.enclosure.open || lacking) std::erase(columns, outside);
    return columns;
}

class PairAreas {
  public:
    PairAreas(std::vector<Pair> pairs, const PairArea& area, const ExchangeOptions& options,
              std::size_t elements)
        : pairs_(std::move(pairs)), values_(pairs_.size()) {
        std::vector<std::exception_ptr> errors(pairs_.size());
        std::atomic<std::size_t> done = 0;
        std::atomic<bool> failed = false, stopped = false;
        std::mutex reporting;
        tbb::parallel_for(std::size_t(0), pairs_.size(), [&](std::size_t k) {
            if (failed || stopped) return;
            try {
                values_[k] = area(ElementId(pairs_[k].i), ElementId(pairs_[k].j));
            } catch (...) {
                errors[k] = std::current_exception();
                failed = true;
            }
            ++done;
            // One thread at a time; who would wait says nothing.
            const std::unique_lock lock(reporting, std::try_to_lock);
            const double fraction = double(done) / double(pairs_.size());
            if (lock && !report(options.progress, {"exchange areas", fraction, elements, 0.0}))
                stopped = true;
        });
        for (const auto& error : errors)
            if (error) std::rethrow_exception(error);
        if (stopped)
            throw mesh::InputError("stopped on request, before all exchange areas were made.");
    }

    double operator()(std::uint32_t i, std::uint32_t j) const {
        const auto found = std::ranges::lower_bound(pairs_, ordered(i, j));
        return values_[static_cast<std::size_t>(found - pairs_.begin())];
    }

  private:
    std::vector<Pair> pairs_;  // ascending
    std::vector<double> values_;
};

}  // namespace

void pair_rows(const Discretization& d, std::span<const ElementId> rows,
               const ExchangeOptions& options, bool lacking, const PairArea& area,
               const RowSink& sink) {
    const Elements& e = d.elements;
    if (e.size() > most_elements)
        throw mesh::InputError(fmt::format(
            "{} elements are too many for a method that takes them two at a time: at most {}. "
            "Choose exchange = \"walked\", or fewer elements (element_size).",
            e.size(), most_elements));
    const auto columns = columns_of(d, options, lacking);
    std::vector<Pair> pairs;
    for (const ElementId row : rows)
        for (const std::uint32_t column : columns) pairs.push_back(ordered(row.value, column));
    std::ranges::sort(pairs);
    pairs.erase(std::ranges::unique(pairs).begin(), pairs.end());
    const PairAreas areas(std::move(pairs), area, options, e.size());
    std::vector<std::uint32_t> kept;
    std::vector<double> values;
    for (const ElementId row : rows) {
        kept.clear();
        values.clear();
        double left = e.capacity[row.value * e.bands + options.band];
        for (const std::uint32_t column : columns) {
            const double value = areas(row.value, column);
            left -= value;
            if (value == 0.0) continue;
            kept.push_back(column);
            values.push_back(value);
        }
        if (lacking && d.enclosure.open) {
            kept.push_back(static_cast<std::uint32_t>(e.outside()));
            values.push_back(left);
        }
        sink({row, kept, values, {}});
    }
}

}  // namespace tyndall::radiosity
