// How a solver came to its solution: what was left after each step.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace tyndall::radiosity {

struct LinearProblem;
struct SolverOptions;

// The state after a step. Let ρ = s + a/c S x − x be what the equation leaves of x.
struct SolverStep {
    std::size_t band = 0;
    // Passes over all entries of the rows, so that solvers compare: two a step of BiCGSTAB, one
    // shot of every element, in the mean, of progressive refinement.
    std::size_t iterations = 0;
    std::size_t shots = 0;      // of progressive refinement
    double cpu_seconds = 0.0;   // of the solver alone, without what this history takes [s]
    double residual = 1.0;      // |ρ| / |s| [-]
    double unshot_power = 0.0;  // π Σ c |ρ| [W]
    // (brought in − absorbed − escaped) / brought in, of x; NaN: not asked for [-].
    double energy_balance = 1.0;
    double ambient = 0.0;  // ambient_estimate of ρ [W/m^2/sr]
};

// Incident radiance that what is unshot will make in the mean, when it has been shot, reflected and
// shot again until nothing is left, if all of the scene saw all of it alike:
//     H = 1/(1 − ā) Σ c ρ / C,   ā = Σ c a / C,   C = Σ_i c_i + Σ_i S_i,out.           (36)
// 0 where nothing absorbs. Source: Cohen et al. (1988), with zones beside patches, and outside
// among what light falls on. Cost: O(elements).
double ambient_estimate(const LinearProblem& problem, std::span<const double> unshot,
                        double outside_area);

// Σ_i S_i,out [m^2]. Cost: O(elements × log entries).
double outside_area(const LinearProblem& problem);

// Keeps steps; of many every second, every fourth, … so that there are never more than `most`.
class SolverHistory {
  public:
    static constexpr std::size_t most = 200;

    // Cost: one pass over the entries, for absorption; none where rows are made on the fly, or no
    // balance is asked for.
    SolverHistory(const LinearProblem& problem, const SolverOptions& options);

    double source_norm() const { return source_norm_; }  // |s|
    // Of an element's radiance: power / π that ends in absorption and outside; NaN where that pass
    // is not taken [W/sr].
    double ended(std::size_t element, double radiance) const;

    // After `iterations` passes, x with ρ = `left`. Returns false if the caller's progress asks for
    // a stop. Cost: O(elements); its time is not counted.
    bool note(std::size_t iterations, std::span<const double> x, std::span<const double> left);
    // The same with power / π that ended in absorption or outside, where who asks knows it
    // [W/sr]. Steps whose turn it is not are left out.
    bool note_shots(std::size_t shots, double ended, std::span<const double> left);
    // Whether note_shots would keep a step now.
    bool wants(std::size_t shots) const { return shots >= next_shots_; }
    // The last state, always kept, in place of one with as many iterations.
    void note_end(std::size_t iterations, std::span<const double> x, std::span<const double> left);
    void note_end_of_shots(std::size_t shots, double ended, std::span<const double> left);

    // Time from here to the end of the scope is not counted. May be nested.
    class Uncounted {
      public:
        explicit Uncounted(SolverHistory& history);
        ~Uncounted();
        Uncounted(const Uncounted&) = delete;
        Uncounted& operator=(const Uncounted&) = delete;

      private:
        SolverHistory& history_;
    };

    std::vector<SolverStep> take() { return std::move(steps_); }

  private:
    SolverStep step_of(std::size_t iterations, double ended, std::span<const double> left) const;
    double ended_of(std::span<const double> x) const;
    void keep(const SolverStep& step);
    void keep_last(const SolverStep& step);
    bool tell(const SolverStep& step) const;

    const LinearProblem& problem_;
    const SolverOptions& options_;
    // t: of x_j, what ends in absorption and outside is Σ_j t_j x_j (column_shares.h); empty where
    // that pass is not taken [m^2].
    std::vector<double> ends_;
    double source_norm_ = 0.0, brought_ = 0.0, outside_area_ = 0.0;
    double began_ = 0.0, uncounted_ = 0.0, paused_at_ = 0.0;  // CPU time [s]
    std::size_t pauses_ = 0;                                  // scopes of Uncounted
    std::vector<SolverStep> steps_;
    std::size_t stride_ = 1, seen_ = 0, next_shots_ = 0;
};

}  // namespace tyndall::radiosity
