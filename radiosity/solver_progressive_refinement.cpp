#include "radiosity/solver_progressive_refinement.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "radiosity/column_shares.h"
#include "radiosity/exchange_columns.h"

namespace tyndall::radiosity {
namespace {

// Rows made on the fly at a time: enough for every thread, few enough to hold.
constexpr std::size_t rows_at_once = 64;

// The columns of kept rows, and what they have yet to send. What an element shoots counts in its
// own column, which goes out at once, and in those of the nodes above it and in the gradients of
// its neighbours: these wait until they have as much to send as others.
struct KeptColumns {
    explicit KeptColumns(const LinearProblem& problem)
        : shares(problem.areas, problem.elements),
          columns(columns_of(problem.areas, shares.columns())),
          self(self_shares(problem, shares)),
          values(shares.columns(), 0.0),
          whole(shares.columns(), 0.0) {
        const bool linear = !columns.moments.empty();
        if (linear) gradients.assign(shares.columns(), Direction(0.0));
        if (linear) whole_moments.assign(shares.columns(), 0.0);
        for (std::size_t j = 0; j < shares.columns(); ++j)
            for (std::size_t k = columns.starts[j]; k < columns.starts[j + 1]; ++k) {
                whole[j] += static_cast<double>(columns.values[k]);
                if (linear) whole_moments[j] += glm::length(Direction(columns.moments[k]));
            }
    }

    // At most what a column that waits would send [W/sr].
    double waiting(std::size_t j) const {
        double power = whole[j] * std::abs(values[j]);
        if (!gradients.empty()) power += whole_moments[j] * glm::length(gradients[j]);
        return power;
    }

    void add(std::size_t element, double power) {
        for (const auto& part : shares.of(element)) {
            values[part.column] += power * part.share;
            if (!gradients.empty()) gradients[part.column] += power * part.gradient;
        }
    }

    ColumnShares shares;
    ExchangeColumns columns;
    std::vector<double> self;           // a_i S_ii/c_i of every element
    std::vector<double> values;         // of columns: yet to be sent [W/m^2/sr]
    std::vector<Direction> gradients;   // the same [W/m^3/sr]; empty: there are none
    std::vector<double> whole;          // Σ_i S_ij [m^2]
    std::vector<double> whole_moments;  // Σ_i |M_ij| [m^3]
};

class Shooting {
  public:
    Shooting(const LinearProblem& problem, const SolverOptions& options)
        : problem_(problem),
          options_(options),
          history_(problem, options),
          size_(problem.elements.size()),
          unshot_(problem.source.begin(), problem.source.end()),
          received_(size_, 0.0),
          outside_area_(outside_area(problem)) {
        if (!problem.rows) kept_.emplace(problem);
        for (std::size_t i = 0; i < size_; ++i) {
            if (!(problem.capacity(i) > 0.0)) unshot_[i] = 0.0;  // sends nothing
            factors_.push_back(problem.scatter_over_capacity(i));
        }
    }

    SolverResult run() {
        history_.note_shots(0, 0.0, unshot_);
        double goal = 0.5 * options_.tolerance * history_.source_norm();
        const std::size_t most = options_.iterations * size_;
        while (!stopped_ && !goes_round() && shots_ < most) {
            if (norm_of(unshot_) <= goal) {
                send_all();
                if (norm_of(unshot_) > goal) continue;
                const double left = measured();
                if (left <= options_.tolerance * history_.source_norm()) break;
                goal *= 0.5 * options_.tolerance * history_.source_norm() / left;
                if (goal < 1e-16 * history_.source_norm()) break;  // beyond what doubles tell
                continue;
            }
            const auto shooters = next_shooters();
            if (shooters.empty()) break;
            shoot(shooters, most);
        }
        return result();
    }

  private:
    // The elements with the most to shoot, and the columns with as much waiting; the one with most
    // first.
    std::vector<ElementId> next_shooters() {
        overshot_ =
            options_.overshooting ? ambient_estimate(problem_, unshot_, outside_area_) : 0.0;
        double most = 0.0;
        powers_.assign(kept_ ? kept_->shares.columns() : size_, 0.0);
        for (std::size_t i = 0; i < powers_.size(); ++i) {
            if (i < size_) powers_[i] = problem_.capacity(i) * std::abs(to_shoot(i));
            if (kept_) powers_[i] += kept_->waiting(i);
            most = std::max(most, powers_[i]);
        }
        std::vector<ElementId> shooters;
        for (std::size_t i = 0; i < powers_.size() && most > 0.0; ++i)
            if (powers_[i] >= options_.shooters * most) shooters.push_back(ElementId(i));
        std::stable_sort(shooters.begin(), shooters.end(), [&](ElementId a, ElementId b) {
            return powers_[a.value] > powers_[b.value];
        });
        if (problem_.rows && shooters.size() > rows_at_once) shooters.resize(rows_at_once);
        return shooters;
    }

    double to_shoot(std::size_t i) const { return unshot_[i] + problem_.scatter(i) * overshot_; }

    void shoot(const std::vector<ElementId>& shooters, std::size_t most) {
        if (problem_.rows) {
            problem_.rows(shooters, [&](const Row& row) {
                if (shots_ < most && !stopped_) shoot_row(row);
            });
            return;
        }
        for (const ElementId shooter : shooters)
            if (shots_ < most && !stopped_) shoot_column(shooter.value);
    }

    void shoot_column(std::size_t i) {
        if (i < size_) {
            const double power = to_shoot(i) * over_itself(kept_->self[i]);
            unshot_[i] -= power;
            kept_->add(i, power);
            ended_ += history_.ended(i, power);
        }
        send(i);
        end_shot();
    }

    // What waits in a column goes to all rows.
    void send(std::size_t j) {
        const ExchangeColumns& columns = kept_->columns;
        const double value = std::exchange(kept_->values[j], 0.0);
        const std::size_t begin = columns.starts[j], end = columns.starts[j + 1];
        if (columns.moments.empty()) {
            for (std::size_t k = begin; k < end; ++k)
                receive(columns.rows[k], value * static_cast<double>(columns.values[k]));
        } else {
            const Direction gradient = std::exchange(kept_->gradients[j], Direction(0.0));
            for (std::size_t k = begin; k < end; ++k)
                receive(columns.rows[k], value * static_cast<double>(columns.values[k]) +
                                             glm::dot(gradient, Direction(columns.moments[k])));
        }
        if (columns.remainders.empty()) return;
        for (std::size_t k = begin; k < end; ++k)
            receive(columns.rows[k], value * static_cast<double>(columns.remainders[k]));
    }

    void send_all() {
        for (std::size_t j = 0; kept_ && j < kept_->shares.columns(); ++j)
            if (kept_->waiting(j) > 0.0) send(j);
    }

    // S_ji is what the shooter's row says of S_ij.
    void shoot_row(const Row& row) {
        const std::size_t i = row.receiver.value, outside = problem_.elements.outside();
        double itself = 0.0;
        for (std::size_t k = 0; k < row.columns.size(); ++k)
            if (row.columns[k] == i) itself = factors_[i] * row.exchange_areas[k];
        const double power = to_shoot(i) * over_itself(itself);
        unshot_[i] -= power;
        for (std::size_t k = 0; k < row.columns.size(); ++k) {
            const std::size_t j = row.columns[k];
            const double arrived = power * row.exchange_areas[k];
            if (j == outside) {
                ended_ += arrived;
                continue;
            }
            ended_ += (1.0 - problem_.scatter(j)) * arrived;
            receive(j, arrived);
        }
        end_shot();
    }

    void receive(std::size_t j, double arrived) {
        received_[j] += arrived;
        unshot_[j] += factors_[j] * arrived;  // (39)
    }

    void end_shot() {
        ++shots_;
        if (history_.wants(shots_)) stopped_ = !history_.note_shots(shots_, ended_, unshot_);
    }

    // Whether nothing of what every element shot has ended anywhere: it never will.
    bool goes_round() {
        if (shots_ < next_look_) return false;
        double unshot = 0.0;
        for (std::size_t i = 0; i < size_; ++i)
            unshot += problem_.capacity(i) * std::abs(unshot_[i]);
        const bool round = shots_ > 0 && std::abs(ended_ - ended_before_) <= 1e-9 * unshot;
        ended_before_ = ended_;
        next_look_ = shots_ + 2 * size_;
        return round || !std::isfinite(unshot);
    }

    // x of all that has been received, what is unshot included.
    std::vector<double> radiance() const {
        std::vector<double> x(size_);
        for (std::size_t i = 0; i < size_; ++i)
            x[i] = problem_.source[i] + factors_[i] * received_[i];
        return x;
    }

    // |ρ| of that, which has reflected what is unshot but not received it again. On the fly: of
    // what has been shot.
    double measured() const {
        return problem_.rows ? norm_of(unshot_) : norm_of(left_of(problem_, radiance()));
    }

    SolverResult result() {
        send_all();
        history_.note_end_of_shots(shots_, ended_, unshot_);
        const bool enough = measured() <= options_.tolerance * history_.source_norm();
        if (options_.ambient && !enough) {
            const double incident = ambient_estimate(problem_, unshot_, outside_area_);
            for (std::size_t i = 0; i < size_; ++i) received_[i] += problem_.capacity(i) * incident;
        }
        SolverResult result;
        result.radiance = radiance();
        result.shots = shots_;
        result.iterations = (shots_ + size_ - 1) / size_;
        result.residual = measured() / history_.source_norm();
        result.converged = enough;
        result.stopped = stopped_;
        result.received = problem_.rows
                              ? received_
                              : multiply(problem_.areas, problem_.elements, result.radiance);
        result.history = history_.take();
        return result;
    }

    const LinearProblem& problem_;
    const SolverOptions& options_;
    SolverHistory history_;
    std::size_t size_;
    std::vector<double> unshot_;    // Δ [W/m^2/sr]
    std::vector<double> received_;  // c H [W/sr]
    double outside_area_;
    std::vector<double> factors_;  // a/c
    std::vector<double> powers_;
    std::optional<KeptColumns> kept_;
    double overshot_ = 0.0;  // H of (36), of overshooting
    double ended_ = 0.0, ended_before_ = 0.0;
    std::size_t shots_ = 0, next_look_ = 0;
    bool stopped_ = false;
};

}  // namespace

SolverResult solve_progressive_refinement(const LinearProblem& problem,
                                          const SolverOptions& options) {
    if (norm_of(problem.source) == 0.0) return dark(problem);
    return Shooting(problem, options).run();
}

}  // namespace tyndall::radiosity
