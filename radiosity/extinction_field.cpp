#include "radiosity/extinction_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "mesh/input_error.h"

namespace tyndall::radiosity {
namespace {

constexpr double towards_corner = 0.4472135954999579;  // 1/√5: the rule's points, from the centroid
constexpr double agreement = 1e-3;                     // of a tet's mean and that of its halves
// A tet that is large beside the grid's grain is halved so often without asking, and more often
// only where its halves disagree.
constexpr int blind_halvings = 9, most_halvings = 12;

// Sums of κ and x κ, means over a tet.
struct Moment {
    double amount = 0.0;
    Point place{0.0};
};

Moment operator+(const Moment& a, const Moment& b) {
    return {0.5 * (a.amount + b.amount), 0.5 * (a.place + b.place)};
}

Moment by_rule(const ExtinctionBand& band, const std::array<Point, 4>& corners) {
    const Point centroid = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
    Moment moment;
    for (const Point& corner : corners) {
        const Point x = centroid + towards_corner * (corner - centroid);
        const double value = 0.25 * band.at(x);
        moment.amount += value;
        moment.place += value * x;
    }
    return moment;
}

// Halves of equal volume, across the longest edge.
std::array<std::array<Point, 4>, 2> halves(const std::array<Point, 4>& corners, double& longest) {
    int a = 0, b = 1;
    longest = -1.0;
    for (int i = 0; i < 4; ++i)
        for (int j = i + 1; j < 4; ++j)
            if (const double length = glm::distance(corners[i], corners[j]); length > longest) {
                longest = length;
                a = i;
                b = j;
            }
    std::array<std::array<Point, 4>, 2> result{corners, corners};
    result[0][a] = result[1][b] = 0.5 * (corners[a] + corners[b]);
    return result;
}

Moment over(const ExtinctionBand& band, const std::array<Point, 4>& corners, const Moment& whole,
            double grain, int level) {
    double longest;
    const auto parts = halves(corners, longest);
    const Moment first = by_rule(band, parts[0]), second = by_rule(band, parts[1]);
    const Moment both = first + second;
    const bool agree = std::abs(both.amount - whole.amount) <= agreement * both.amount;
    const bool seen = longest <= 2.0 * grain || level >= blind_halvings;
    if (level == most_halvings || (seen && agree)) return both;
    return over(band, parts[0], first, grain, level + 1) +
           over(band, parts[1], second, grain, level + 1);
}

// The function's values while the grid gets finer.
class FunctionSampler {
  public:
    FunctionSampler(const std::function<double(Point)>& function, Point low, Point high,
                    const SampleOptions& options)
        : function_(function), low_(low), high_(high), options_(options) {}

    SampledFunction run() {
        counts_ = {first_cells + 1, first_cells + 1, first_cells + 1};
        for (std::size_t k = 0; k < counts_[2]; ++k)
            for (std::size_t j = 0; j < counts_[1]; ++j)
                for (std::size_t i = 0; i < counts_[0]; ++i)
                    values_.push_back(value({double(i), double(j), double(k)}));
        SampledFunction result;
        result.error = refine();
        result.first = values_.front();
        result.uniform = std::all_of(values_.begin(), values_.end(),
                                     [&](double v) { return v == values_.front(); });
        for (int axis = 0; axis < 3; ++axis) join(axis);
        result.grid = std::make_shared<const RegularGrid>(
            counts_, low_, high_, std::vector<float>(values_.begin(), values_.end()),
            BeyondGrid::edge);
        return result;
    }

  private:
    static constexpr std::size_t first_cells = 16;
    static constexpr double lossless = 1e-7;  // of the largest value: below what floats resolve

    // At a place given in points of the grid.
    double value(const glm::dvec3& place) {
        Point x;
        for (int axis = 0; axis < 3; ++axis) {
            const double t = place[axis] / static_cast<double>(counts_[axis] - 1);
            x[axis] = (1.0 - t) * low_[axis] + t * high_[axis];
        }
        const double v = function_(x);
        if (!(v >= 0.0) || v > 1e30)
            throw mesh::InputError(fmt::format("it is {} at [{:.6g}, {:.6g}, {:.6g}] m, {}", v, x.x,
                                               x.y, x.z,
                                               v < 0.0 ? "below 0" : "not a number up to 1e30"));
        largest_ = std::max(largest_, v);
        return v;
    }

    std::size_t stride(int axis) const {
        return axis == 0 ? 1 : axis == 1 ? counts_[0] : counts_[0] * counts_[1];
    }

    // Values halfway between the points along an axis, and the largest departure from linear.
    double look_between(int axis, std::vector<double>& between) {
        auto counts = counts_;
        --counts[axis];
        between.clear();
        double worst = 0.0;
        for (std::size_t k = 0; k < counts[2]; ++k)
            for (std::size_t j = 0; j < counts[1]; ++j)
                for (std::size_t i = 0; i < counts[0]; ++i) {
                    glm::dvec3 place(i, j, k);
                    place[axis] += 0.5;
                    between.push_back(value(place));
                    const double* at = &values_[i + counts_[0] * (j + counts_[1] * k)];
                    worst = std::max(worst,
                                     std::abs(between.back() - 0.5 * (at[0] + at[stride(axis)])));
                }
        return worst;
    }

    // Every second point along the axis from `between`.
    void interleave(int axis, const std::vector<double>& between) {
        auto counts = counts_;
        counts[axis] = 2 * counts_[axis] - 1;
        auto fewer = counts_;
        --fewer[axis];
        std::vector<double> all;
        all.reserve(counts[0] * counts[1] * counts[2]);
        for (std::size_t k = 0; k < counts[2]; ++k)
            for (std::size_t j = 0; j < counts[1]; ++j)
                for (std::size_t i = 0; i < counts[0]; ++i) {
                    std::array<std::size_t, 3> p{i, j, k};
                    const bool old = p[axis] % 2 == 0;
                    p[axis] /= 2;
                    all.push_back(old ? values_[p[0] + counts_[0] * (p[1] + counts_[1] * p[2])]
                                      : between[p[0] + fewer[0] * (p[1] + fewer[1] * p[2])]);
                }
        counts_ = counts;
        values_ = std::move(all);
    }

    bool may_refine(int axis) const {
        auto counts = counts_;
        counts[axis] = 2 * counts_[axis] - 1;
        return counts[axis] <= options_.most_cells + 1 &&
               counts[0] * counts[1] * counts[2] <= options_.most_points;
    }

    // Returns the departure that is left, of the largest value.
    double refine() {
        std::vector<double> between;
        std::array<double, 3> departs{};
        for (bool finer = true; finer;) {
            finer = false;
            for (int axis = 0; axis < 3; ++axis) {
                departs[axis] = look_between(axis, between);
                if (departs[axis] <= options_.tolerance * largest_ || !may_refine(axis)) continue;
                interleave(axis, between);
                finer = true;
            }
        }
        return largest_ > 0.0 ? *std::max_element(departs.begin(), departs.end()) / largest_ : 0.0;
    }

    // Leaves out every second point along the axis while it is the mean of its neighbours.
    void join(int axis) {
        while (counts_[axis] > 2) {
            auto counts = counts_;
            counts[axis] = (counts_[axis] + 1) / 2;
            std::vector<double> kept;
            for (std::size_t at = 0; at < values_.size(); ++at) {
                const std::size_t p = at / stride(axis) % counts_[axis];
                if (p % 2 == 0) {
                    kept.push_back(values_[at]);
                } else {
                    const double mean =
                        0.5 * (values_[at - stride(axis)] + values_[at + stride(axis)]);
                    if (std::abs(values_[at] - mean) > lossless * largest_) return;
                }
            }
            values_ = std::move(kept);
            counts_ = counts;
        }
    }

    const std::function<double(Point)>& function_;
    Point low_, high_;
    const SampleOptions& options_;
    std::array<std::size_t, 3> counts_{};
    std::vector<double> values_;
    double largest_ = 0.0;
};

}  // namespace

TetExtinction over_tet(const ExtinctionBand& band, const std::array<Point, 4>& corners) {
    const Direction grain = band.shape->grain();
    const Moment moment =
        over(band, corners, by_rule(band, corners), std::min({grain.x, grain.y, grain.z}), 0);
    const Point centroid = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
    return {moment.amount, moment.amount > 0.0 ? moment.place / moment.amount : centroid};
}

double rough_mean(const ExtinctionBand& band, const std::array<Point, 4>& corners) {
    return by_rule(band, corners).amount;
}

SampledFunction sample_function(const std::function<double(Point)>& function, Point low, Point high,
                                const SampleOptions& options) {
    return FunctionSampler(function, low, high, options).run();
}

}  // namespace tyndall::radiosity
