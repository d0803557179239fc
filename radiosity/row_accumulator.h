// Sums a sparse row: a dense array, and bits that remember what was touched, in order.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

namespace tyndall::radiosity {

// Cost of a row: its deposits, its entries, and columns / 4096; none of sorting.
template <class Value>
class RowAccumulator {
  public:
    explicit RowAccumulator(std::size_t columns)
        : values_(columns, Value(0.0)), touched_(columns / 64 + 1), words_(columns / 4096 + 1) {}

    void add(std::uint32_t column, const Value& value) {
        values_[column] += value;
        touched_[column >> 6] |= 1ull << (column & 63);
        words_[column >> 12] |= 1ull << (column >> 6 & 63);
    }

    // Calls take(column, sum) for every touched column, ascending, and forgets them.
    template <class Take>
    void take(Take&& take) {
        for (std::size_t w = 0; w < words_.size(); ++w)
            for (; words_[w] != 0; words_[w] &= words_[w] - 1) {
                const std::size_t t =
                    64 * w + static_cast<std::size_t>(std::countr_zero(words_[w]));
                for (; touched_[t] != 0; touched_[t] &= touched_[t] - 1) {
                    const std::size_t column =
                        64 * t + static_cast<std::size_t>(std::countr_zero(touched_[t]));
                    take(static_cast<std::uint32_t>(column), values_[column]);
                    values_[column] = Value(0.0);
                }
            }
    }

  private:
    std::vector<Value> values_;
    std::vector<std::uint64_t> touched_, words_;  // a bit a column; a bit a word of that
};

}  // namespace tyndall::radiosity
