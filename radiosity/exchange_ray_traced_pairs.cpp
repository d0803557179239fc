#include "radiosity/exchange_ray_traced_pairs.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "radiosity/pair_integral.h"

namespace tyndall::radiosity {
namespace {

constexpr std::size_t most_entries = 1u << 24;  // of the table of a batch of rows

class Batches {
  public:
    Batches(const Discretization& d, std::span<const ElementId> rows,
            const ExchangeOptions& options)
        : d_(d),
          rows_(rows),
          options_(options),
          pieces_(d, options.band),
          integral_(d.enclosure, options.band, options.settings.tolerance),
          column_of_(d.elements.size() + 1, none),
          row_of_(d.elements.size() + 1, none) {
        if (options.columns.empty() || radius() > 0.0)
            for (std::size_t j = 0; j <= d.elements.size(); ++j) columns_.push_back(entry_of(j));
        else
            for (const ElementId column : options.columns) columns_.push_back(column.value);
        std::ranges::sort(columns_);
        columns_.erase(std::ranges::unique(columns_).begin(), columns_.end());
        for (std::size_t c = 0; c < columns_.size(); ++c) column_of_[columns_[c]] = entry_of(c);
    }

    void make(const RowSink& sink) {
        const std::size_t batch = std::max<std::size_t>(1, most_entries / columns_.size());
        for (begin_ = 0; begin_ < rows_.size(); begin_ = end_) {
            end_ = std::min(begin_ + batch, rows_.size());
            fill();
            for (std::size_t r = begin_; r < end_; ++r) give(r, sink);
        }
    }

  private:
    static std::uint32_t entry_of(std::size_t index) { return static_cast<std::uint32_t>(index); }
    double radius() const { return options_.settings.interaction_radius; }

    bool far(std::uint32_t i, std::uint32_t j) const {
        return radius() > 0.0 && j != d_.elements.outside() && pieces_.gap(i, j) > radius();
    }

    double& value(std::size_t row, std::size_t column) {
        return values_[(row - begin_) * columns_.size() + column];
    }

    // All pairs of the batch. As in walked rows a stop that is asked for waits for the last row.
    void fill() {
        values_.assign((end_ - begin_) * columns_.size(), 0.0);
        std::ranges::fill(row_of_, none);
        for (std::size_t r = begin_; r < end_; ++r) row_of_[rows_[r].value] = entry_of(r);
        // In parts, between which progress is reported: a batch may be all there is.
        constexpr std::size_t parts = 64;
        const std::size_t pairs = values_.size();
        for (std::size_t part = 0; part < parts; ++part) {
            tbb::parallel_for(pairs * part / parts, pairs * (part + 1) / parts, [&](std::size_t k) {
                evaluate(begin_ + k / columns_.size(), k % columns_.size());
            });
            const double done = double(begin_) + double(end_ - begin_) * (part + 1) / parts;
            report(options_.progress,
                   {"exchange areas", done / double(rows_.size()), d_.elements.size(), 0.0});
        }
    }

    // The pair's value goes to both rows if both are in the batch: the lower one's turn.
    void evaluate(std::size_t row, std::size_t column) {
        const std::uint32_t i = rows_[row].value, j = columns_[column];
        const std::uint32_t other_row = row_of_[j], other_column = column_of_[i];
        const bool both = other_row != none && other_column != none && row_of_[i] == row && i != j;
        if (both && j < i) return;
        if (far(i, j)) return;
        const auto [low, high] = std::minmax(i, j);
        const double area = integral_(pieces_[low], pieces_[high], i == j);
        value(row, column) = area;
        if (both) value(other_row, other_column) = area;
    }

    void give(std::size_t r, const RowSink& sink) {
        row_columns_.clear();
        row_values_.clear();
        for (std::size_t c = 0; c < columns_.size(); ++c) {
            if (!(value(r, c) > 0.0)) continue;
            row_columns_.push_back(columns_[c]);
            row_values_.push_back(value(r, c));
        }
        if (radius() > 0.0) close(rows_[r].value);
        sink({rows_[r], row_columns_, row_values_, {}});
    }

    // Scales all entries but outside's to what they must add up to.
    void close(std::uint32_t i) {
        const double capacity = d_.elements.capacity[i * d_.elements.bands + options_.band];
        const bool open = !row_columns_.empty() && row_columns_.back() == d_.elements.outside();
        const std::size_t inner = row_columns_.size() - open;
        double sum = 0.0;
        for (std::size_t k = 0; k < inner; ++k) sum += row_values_[k];
        const double rest = std::max(0.0, capacity - (open ? row_values_.back() : 0.0));
        if (sum > 0.0) {
            for (std::size_t k = 0; k < inner; ++k) row_values_[k] *= rest / sum;
        } else if (rest > 0.0) {
            // Nothing is near: what is far is taken to shine as the element itself.
            row_columns_.insert(row_columns_.begin(), i);
            row_values_.insert(row_values_.begin(), rest);
        }
    }

    const Discretization& d_;
    std::span<const ElementId> rows_;
    const ExchangeOptions& options_;
    ElementPieces pieces_;
    PairIntegral integral_;
    std::vector<std::uint32_t> columns_, column_of_, row_of_;  // ascending; of elements, or none
    std::size_t begin_ = 0, end_ = 0;                          // rows of the batch
    std::vector<double> values_;                               // a row of columns each [m^2]
    std::vector<std::uint32_t> row_columns_;
    std::vector<double> row_values_;
};

}  // namespace

void exchange_ray_traced_pairs(const Discretization& discretization,
                               std::span<const ElementId> rows, const ExchangeOptions& options,
                               const RowSink& sink) {
    Batches(discretization, rows, options).make(sink);
}

}  // namespace tyndall::radiosity
