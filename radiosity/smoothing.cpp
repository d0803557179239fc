#include "radiosity/smoothing.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "mesh/input_error.h"

namespace tyndall::radiosity {
namespace {

constexpr std::array<std::string_view, 3> names{"none", "least_squares", "scaling"};

// Of a row's capacity: a hundred times what rounding leaves of sums of some hundred entries.
constexpr double closes = 1e-12;

using Values = std::vector<double>;

// Rows of a symmetric matrix, entries on both sides of the diagonal; the last column is outside.
struct Symmetric {
    std::vector<std::size_t> starts{0};
    LargeVector<std::uint32_t> columns;
    std::vector<double> values;

    std::size_t rows() const { return starts.size() - 1; }
};

// S^T without outside's row.
Symmetric transposed(const ExchangeAreas& raw) {
    const std::size_t n = raw.rows();
    Symmetric result;
    result.starts.assign(n + 1, 0);
    for (const auto column : raw.columns)
        if (column < n) ++result.starts[column + 1];
    std::partial_sum(result.starts.begin(), result.starts.end(), result.starts.begin());
    result.columns.resize(result.starts.back());
    result.values.resize(result.starts.back());
    auto next = result.starts;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = raw.starts[i]; k < raw.starts[i + 1]; ++k) {
            if (raw.columns[k] >= n) continue;
            const std::size_t to = next[raw.columns[k]]++;
            result.columns[to] = static_cast<std::uint32_t>(i);
            result.values[to] = raw.value(k);
        }
    return result;
}

// visit(column, S_ij, S_ji) for every column of row i that either has.
template <class Visit>
void merge(const ExchangeAreas& raw, const Symmetric& back, std::size_t i, Visit&& visit) {
    std::size_t a = raw.starts[i], b = back.starts[i];
    const std::size_t a_end = raw.starts[i + 1], b_end = back.starts[i + 1];
    while (a < a_end || b < b_end) {
        const auto forth_column = a < a_end ? raw.columns[a] : none;
        const auto back_column = b < b_end ? back.columns[b] : none;
        const auto column = std::min(forth_column, back_column);
        const double forth = forth_column == column ? raw.value(a++) : 0.0;
        const double returned = column == raw.rows()    ? forth
                                : back_column == column ? back.values[b++]
                                                        : 0.0;
        visit(column, forth, returned);
    }
}

// S̄ on the union of the patterns of S and S^T.
Symmetric mean_of(const ExchangeAreas& raw, const Values& capacity) {
    const std::size_t n = raw.rows();
    const Symmetric back = transposed(raw);
    Symmetric mean;
    mean.starts.assign(n + 1, 0);
    tbb::parallel_for(std::size_t(0), n, [&](std::size_t i) {
        merge(raw, back, i, [&](std::uint32_t, double, double) { ++mean.starts[i + 1]; });
    });
    std::partial_sum(mean.starts.begin(), mean.starts.end(), mean.starts.begin());
    mean.columns.resize(mean.starts.back());
    mean.values.resize(mean.starts.back());
    tbb::parallel_for(std::size_t(0), n, [&](std::size_t i) {
        std::size_t k = mean.starts[i];
        merge(raw, back, i, [&](std::uint32_t column, double forth, double returned) {
            const bool there = capacity[i] > 0.0 && (column == n || capacity[column] > 0.0);
            mean.columns[k] = column;
            mean.values[k++] = there ? 0.5 * (forth + returned) : 0.0;
        });
    });
    return mean;
}

// What a method makes of an entry of S̄, given multipliers (outside's is 0), and how that changes
// with their sum.
class LeastSquares {
  public:
    void set(const Values& multipliers) { multipliers_ = multipliers; }
    double value(std::size_t i, std::size_t j, double mean) const {
        return std::max(0.0, mean + mean * mean * (multipliers_[i] + multipliers_[j]));  // (32)
    }
    static double weight(double mean, double value) { return value > 0.0 ? mean * mean : 0.0; }

  private:
    Values multipliers_;
};

class Scaling {
  public:
    void set(const Values& multipliers) {
        factors_.resize(multipliers.size());
        std::transform(multipliers.begin(), multipliers.end(), factors_.begin(),
                       [](double m) { return std::exp(m); });
    }
    double value(std::size_t i, std::size_t j, double mean) const {
        return factors_[i] * factors_[j] * mean;  // (33)
    }
    static double weight(double, double value) { return value; }

  private:
    Values factors_;
};

// Finds the multipliers with which rows close.
template <class Law>
class Closing {
  public:
    Closing(const Symmetric& mean, const Values& capacity)
        : mean_(mean), capacity_(capacity), multipliers_(capacity.size() + 1, 0.0) {
        law_.set(multipliers_);
        missing_ = missing();
    }

    const Law& law() const { return law_; }
    std::size_t passes() const { return passes_; }
    bool closed() const {
        for (std::size_t i = 0; i < capacity_.size(); ++i)
            if (!(std::abs(missing_[i]) <= closes * capacity_[i])) return false;
        return true;
    }

    // f_i ← √(f_i c_i / Σ_j S̄_ij f_j): Sinkhorn's iteration, halved so that it stays symmetric.
    void sinkhorn(std::size_t sweeps) {
        for (std::size_t sweep = 0; sweep < sweeps && !closed(); ++sweep) {
            for (std::size_t i = 0; i < capacity_.size(); ++i)
                if (const double sum = capacity_[i] - missing_[i]; sum > 0.0)
                    multipliers_[i] += 0.5 * std::log(capacity_[i] / sum);
            law_.set(multipliers_);
            missing_ = missing();
        }
    }

    // Newton's steps, each halved until rows miss less than before.
    void newton(std::size_t steps) {
        for (std::size_t step = 0; step < steps && !closed(); ++step) {
            const Values direction = solve();
            const Values from = multipliers_;
            const double before = total(missing_);
            bool better = false;
            for (double share = 1.0; share > 1e-4 && !better; share *= 0.5) {
                for (std::size_t i = 0; i < direction.size(); ++i)
                    multipliers_[i] = from[i] + share * direction[i];
                law_.set(multipliers_);
                Values missed = missing();
                better = total(missed) < before;
                if (better) missing_ = std::move(missed);
            }
            if (better) continue;
            multipliers_ = from;
            law_.set(multipliers_);
            return;
        }
    }

  private:
    static double total(const Values& v) {
        double sum = 0.0;
        for (const double x : v) sum += std::abs(x);
        return sum;
    }
    static double dot(const Values& a, const Values& b) {
        return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
    }

    // Σ_j f(column, S̄_ij) of every row.
    template <class Term>
    Values sums(Term&& term) {
        ++passes_;
        Values result(mean_.rows());
        tbb::parallel_for(std::size_t(0), result.size(), [&](std::size_t i) {
            double sum = 0.0;
            for (std::size_t k = mean_.starts[i]; k < mean_.starts[i + 1]; ++k)
                sum += term(i, mean_.columns[k], mean_.values[k]);
            result[i] = sum;
        });
        return result;
    }

    // c_i − Σ_j S'_ij.
    Values missing() {
        Values result =
            sums([&](std::size_t i, std::size_t j, double m) { return law_.value(i, j, m); });
        for (std::size_t i = 0; i < result.size(); ++i) result[i] = capacity_[i] - result[i];
        return result;
    }

    double weight(std::size_t i, std::size_t j, double mean) const {
        return Law::weight(mean, law_.value(i, j, mean));
    }

    // (34) by conjugate gradients, the diagonal as preconditioner. The matrix is that of a signless
    // Laplacian: no eigenvalue below 0, and 0 only where elements fall into two groups that
    // exchange with each other alone; the right-hand side is then in its range, or rows cannot
    // close. Four digits are enough of a Newton step.
    Values solve() {
        Values inverse = sums([&](std::size_t i, std::size_t j, double m) {
            return weight(i, j, m) * (i == j ? 2.0 : 1.0);
        });
        for (double& d : inverse) d = d > 0.0 ? 1.0 / d : 0.0;
        const std::size_t n = inverse.size();
        Values x(n, 0.0), residual = missing_, z(n), p(n + 1, 0.0);
        const auto precondition = [&] {
            for (std::size_t i = 0; i < n; ++i) z[i] = inverse[i] * residual[i];
            return dot(z, residual);
        };
        double rho = precondition();
        std::copy(z.begin(), z.end(), p.begin());
        const double enough = 1e-8 * rho;  // a square
        for (std::size_t iteration = 0; iteration < 500 && rho > enough; ++iteration) {
            const Values q = sums([&](std::size_t i, std::size_t j, double m) {
                return weight(i, j, m) * (p[i] + p[j]);
            });
            const double curvature = dot(q, p);
            if (!(curvature > 0.0)) break;
            const double length = rho / curvature;
            for (std::size_t i = 0; i < n; ++i) {
                x[i] += length * p[i];
                residual[i] -= length * q[i];
            }
            const double before = rho;
            rho = precondition();
            for (std::size_t i = 0; i < n; ++i) p[i] = z[i] + rho / before * p[i];
        }
        return x;
    }

    const Symmetric& mean_;
    const Values& capacity_;
    Law law_;
    Values multipliers_, missing_;
    std::size_t passes_ = 0;
};

// S' in place of S̄.
template <class Law>
void apply(Symmetric& mean, const Closing<Law>& closing, SmoothingReport& report) {
    tbb::parallel_for(std::size_t(0), mean.rows(), [&](std::size_t i) {
        for (std::size_t k = mean.starts[i]; k < mean.starts[i + 1]; ++k)
            if (double& value = mean.values[k]; value > 0.0) {
                value = closing.law().value(i, mean.columns[k], value);
                // Marked for the count, which is no task's alone.
                if (value == 0.0) value = -0.0;
            }
    });
    report.clamped = static_cast<std::size_t>(
        std::count_if(mean.values.begin(), mean.values.end(),
                      [](double value) { return value == 0.0 && std::signbit(value); }));
    report.iterations = closing.passes();
    report.converged = closing.closed();
}

// What smoothing made, in the form of rows, and how far each row was moved.
ExchangeAreas finished(const ExchangeAreas& raw, Symmetric smoothed, const Values& capacity,
                       SmoothingReport& report) {
    ExchangeAreas result;
    const std::size_t n = smoothed.rows(), entries = smoothed.columns.size();
    result.values.resize(entries);
    result.remainders.resize(entries);
    if (!raw.moments.empty()) result.moments.resize(entries, glm::vec3(0.0f));
    Values moved(n, 0.0);
    tbb::parallel_for(std::size_t(0), n, [&](std::size_t i) {
        std::size_t r = raw.starts[i];
        double change = 0.0;
        for (std::size_t k = smoothed.starts[i]; k < smoothed.starts[i + 1]; ++k) {
            const double value = smoothed.values[k] + 0.0;  // without the mark
            result.values[k] = static_cast<float>(value);
            result.remainders[k] = static_cast<float>(value - double(result.values[k]));
            const bool had = r < raw.starts[i + 1] && raw.columns[r] == smoothed.columns[k];
            const double before = had ? raw.value(r) : 0.0;
            change += std::abs(value - before);
            if (before > 0.0 && !raw.moments.empty())
                result.moments[k] = static_cast<float>(value / before) * raw.moments[r];
            r += had;
        }
        if (capacity[i] > 0.0) moved[i] = change / capacity[i];
    });
    const auto rows =
        std::count_if(capacity.begin(), capacity.end(), [](double c) { return c > 0.0; });
    if (rows > 0) {
        report.moved_max = *std::max_element(moved.begin(), moved.end());
        report.moved_mean = std::accumulate(moved.begin(), moved.end(), 0.0) / double(rows);
    }
    result.starts = std::move(smoothed.starts);
    result.columns = std::move(smoothed.columns);
    result.gradients = raw.gradients;
    return result;
}

}  // namespace

ExchangeAreas smooth(ExchangeAreas raw, const Elements& elements, std::size_t band,
                     Smoothing method) {
    if (method == Smoothing::none) return raw;
    check_smoothing(method, raw.levels.empty() ? 0.0 : 1.0);
    SmoothingReport report{.method = method,
                           .raw_closure_error = closure_error(raw, elements, band),
                           .raw_reciprocity_error = reciprocity_error(raw, elements)};
    Values capacity(elements.size());
    for (std::size_t i = 0; i < capacity.size(); ++i)
        capacity[i] = elements.capacity[i * elements.bands + band];
    Symmetric mean = mean_of(raw, capacity);
    // Newton's method ends by itself; limits are for rows that cannot close.
    if (method == Smoothing::least_squares) {
        Closing<LeastSquares> closing(mean, capacity);
        closing.newton(100);
        apply(mean, closing, report);
    } else {
        Closing<Scaling> closing(mean, capacity);
        closing.sinkhorn(20);
        closing.newton(100);
        apply(mean, closing, report);
    }
    ExchangeAreas result = finished(raw, std::move(mean), capacity, report);
    result.smoothing = report;
    return result;
}

SmoothingReport worse_of(const SmoothingReport& a, const SmoothingReport& b) {
    SmoothingReport result = a;
    for (const auto member :
         {&SmoothingReport::raw_closure_error, &SmoothingReport::raw_reciprocity_error,
          &SmoothingReport::moved_max, &SmoothingReport::moved_mean})
        result.*member = std::max(a.*member, b.*member);
    result.clamped = std::max(a.clamped, b.clamped);
    result.iterations = std::max(a.iterations, b.iterations);
    result.converged = a.converged && b.converged;
    return result;
}

void check_smoothing(Smoothing method, double row_detail) {
    if (method != Smoothing::none && row_detail > 0.0)
        throw mesh::InputError(fmt::format(
            "smoothing \"{}\" changes exchange areas pair by pair, and rows with level of detail "
            "(row_detail) do not have every pair. Set row_detail to 0, or smoothing to \"none\".",
            smoothing_name(method)));
}

std::span<const std::string_view> smoothing_names() {
    return names;
}

std::string_view smoothing_name(Smoothing method) {
    return names[static_cast<std::size_t>(method)];
}

Smoothing smoothing_named(std::string_view name) {
    const auto found = std::ranges::find(names, name);
    if (found == names.end())
        throw mesh::InputError(
            fmt::format("there is no smoothing \"{}\". Choose one of {}, {}, {}.", name, names[0],
                        names[1], names[2]));
    return static_cast<Smoothing>(found - names.begin());
}

}  // namespace tyndall::radiosity
