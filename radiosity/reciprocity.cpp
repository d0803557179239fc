#include <algorithm>
#include <cmath>

#include "radiosity/exchange.h"
#include "radiosity/point_set.h"

namespace tyndall::radiosity {
namespace {

// S_ij with what row i holds in the nodes above j.
double spread_entry(const ExchangeAreas& areas, std::size_t i, std::uint32_t j) {
    double sum = entry(areas, i, j), share = 1.0;
    if (areas.levels.empty()) return sum;
    for (std::uint32_t node = j; areas.levels.parent[node] != none;) {
        share *= areas.levels.share[node];
        node = areas.levels.parent[node];
        sum += share * entry(areas, i, node);
    }
    return sum;
}

// Draws elements below columns by their shares.
class Drawer {
  public:
    explicit Drawer(const RowLevels& levels) : levels_(levels), starts_(levels.columns() + 1) {
        for (const auto parent : levels.parent)
            if (parent != none) ++starts_[parent + 1];
        for (std::size_t c = 0; c + 1 < starts_.size(); ++c) starts_[c + 1] += starts_[c];
        children_.resize(starts_.back());
        auto next = starts_;
        for (std::uint32_t c = 0; c < levels.columns(); ++c)
            if (const auto parent = levels.parent[c]; parent != none) children_[next[parent]++] = c;
    }

    struct Drawn {
        std::uint32_t element;
        double share;  // of the column
    };
    Drawn draw(std::uint32_t column, std::uint64_t seed) const {
        Drawn drawn{column, 1.0};
        for (std::uint64_t step = 0; !levels_.empty(); ++step) {
            const auto begin = starts_[drawn.element], end = starts_[drawn.element + 1];
            if (begin == end) break;
            double u = 0x1p-53 * static_cast<double>(hash_seed(seed, step) >> 11);
            auto child = begin;
            while (child + 1 < end && u >= levels_.share[children_[child]])
                u -= levels_.share[children_[child++]];
            drawn.element = children_[child];
            drawn.share *= levels_.share[drawn.element];
        }
        return drawn;
    }

  private:
    const RowLevels& levels_;
    std::vector<std::size_t> starts_;
    std::vector<std::uint32_t> children_;
};

}  // namespace

double reciprocity_error(const ExchangeAreas& areas, const Elements& elements) {
    constexpr std::size_t sampled_rows = 64, sampled_entries = 256;
    const Drawer drawer(areas.levels);
    const std::size_t stride = std::max<std::size_t>(1, areas.rows() / sampled_rows);
    double difference = 0.0, total = 0.0;
    for (std::size_t i = 0; i < areas.rows(); i += stride) {
        const std::size_t begin = areas.starts[i], end = areas.starts[i + 1];
        const std::size_t step = std::max<std::size_t>(1, (end - begin) / sampled_entries);
        // One of each `step` entries stands for them all.
        for (std::size_t first = begin; first < end; first += step) {
            const std::size_t of = std::min(step, end - first);
            const std::size_t k = first + hash_seed(i, first) % of;
            if (areas.columns[k] == elements.outside()) continue;
            const auto [j, share] = drawer.draw(areas.columns[k], hash_seed(i, k));
            const double value = static_cast<double>(of) * areas.value(k);
            total += value;
            const double forth = areas.levels.empty() ? areas.value(k) : spread_entry(areas, i, j);
            if (!(forth > 0.0)) continue;
            const double back = spread_entry(areas, j, static_cast<std::uint32_t>(i));
            // Other columns of the row may stand for j too: this one answers for its part. A pair
            // that is seen from one end only is met once here but twice in the sum.
            difference += value / forth * std::abs(forth - back) * (back > 0.0 ? 1.0 : 2.0);
        }
    }
    return total > 0.0 ? difference / total : 0.0;
}

}  // namespace tyndall::radiosity
