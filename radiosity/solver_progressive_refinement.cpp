#include "radiosity/solver_progressive_refinement.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "radiosity/column_shares.h"
#include "radiosity/exchange_columns.h"

namespace tyndall::radiosity {
namespace {

// Rows made on the fly at a time: enough for every thread, few enough to hold.
constexpr std::size_t rows_at_once = 64;

// The columns of kept rows, and what of them an element's value counts in.
struct KeptColumns {
    explicit KeptColumns(const LinearProblem& problem)
        : shares(problem.areas, problem.elements),
          columns(columns_of(problem.areas, shares.columns())),
          self(self_shares(problem, shares)) {}

    ColumnShares shares;
    ExchangeColumns columns;
    std::vector<double> self;  // a_i S_ii/c_i of every element
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
                const double left = measured();
                if (left <= options_.tolerance * history_.source_norm()) break;
                goal *= 0.5 * options_.tolerance * history_.source_norm() / left;
                continue;
            }
            const auto shooters = next_shooters();
            if (shooters.empty()) break;
            shoot(shooters, most);
        }
        return result();
    }

  private:
    // The elements with the most to shoot, the one with most first.
    std::vector<ElementId> next_shooters() {
        overshot_ =
            options_.overshooting ? ambient_estimate(problem_, unshot_, outside_area_) : 0.0;
        double most = 0.0;
        powers_.resize(size_);
        for (std::size_t i = 0; i < size_; ++i) {
            powers_[i] = problem_.capacity(i) * std::abs(to_shoot(i));
            most = std::max(most, powers_[i]);
        }
        std::vector<ElementId> shooters;
        for (std::size_t i = 0; i < size_ && most > 0.0; ++i)
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
        const double power = to_shoot(i) * over_itself(kept_->self[i]);
        unshot_[i] -= power;
        const ExchangeColumns& columns = kept_->columns;
        for (const auto& part : kept_->shares.of(i)) {
            const double share = power * part.share;
            const Direction gradient = power * part.gradient;
            for (std::size_t k = columns.starts[part.column]; k < columns.starts[part.column + 1];
                 ++k) {
                double arrived = share * static_cast<double>(columns.values[k]);
                if (!columns.remainders.empty())
                    arrived += share * static_cast<double>(columns.remainders[k]);
                if (!columns.moments.empty())
                    arrived += glm::dot(gradient, Direction(columns.moments[k]));
                receive(columns.rows[k], arrived);
            }
        }
        end_shot(history_.ends()[i] * power);
    }

    // S_ji is what the shooter's row says of S_ij.
    void shoot_row(const Row& row) {
        const std::size_t i = row.receiver.value, outside = problem_.elements.outside();
        double itself = 0.0;
        for (std::size_t k = 0; k < row.columns.size(); ++k)
            if (row.columns[k] == i) itself = factors_[i] * row.exchange_areas[k];
        const double power = to_shoot(i) * over_itself(itself);
        unshot_[i] -= power;
        double ended = 0.0;
        for (std::size_t k = 0; k < row.columns.size(); ++k) {
            const std::size_t j = row.columns[k];
            const double arrived = power * row.exchange_areas[k];
            if (j == outside) {
                ended += arrived;
                continue;
            }
            ended += (1.0 - problem_.scatter(j)) * arrived;
            receive(j, arrived);
        }
        end_shot(ended);
    }

    void receive(std::size_t j, double arrived) {
        received_[j] += arrived;
        unshot_[j] += factors_[j] * arrived;  // (39)
    }

    void end_shot(double ended) {
        ended_ += ended;
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
