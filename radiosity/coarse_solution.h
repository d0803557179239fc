// The coarse solution: rows of exchange areas kept (or, with Shots::on_the_fly, made whenever one
// is asked for), solved again whenever direct light is known better.
#pragma once

#include "radiosity/exchange_moved.h"
#include "radiosity/options.h"
#include "radiosity/settled_emission.h"
#include "radiosity/shared_rows.h"
#include "radiosity/solution.h"
#include "radiosity/solver.h"

namespace tyndall::radiosity {

struct NamedSolver;

// Rows of the same elements before bodies have moved, of each distinct extinction.
struct KeptRows {
    Discretization discretization;
    const RowSet& rows;
    std::span<const glm::vec3> directions;  // of their rays (ray_directions)
    // What their solution sent out, of patches less what they reflect of direct light, to begin
    // with ([element * bands + band]) [W/m^2/sr].
    std::span<const double> sent;
};

class CoarseSolution {
  public:
    // The elements are the forest's leaves now; rows are made here, once a distinct extinction,
    // of all by one walk where the method can.
    CoarseSolution(const Enclosure& enclosure, const Forest& forest, const SolveOptions& options,
                   const ProgressCallback& progress);
    // With elements of the caller's, clusters for instance. In place of rows made anew: those of
    // `kept`, in which what has moved since is corrected (exchange_moved.h); or `made`, of the same
    // elements, as they are.
    CoarseSolution(const Enclosure& enclosure, const Forest& forest, Elements elements,
                   const SolveOptions& options, const ProgressCallback& progress,
                   const KeptRows* kept = nullptr, std::shared_ptr<const RowSet> made = {});

    const Elements& elements() const { return elements_; }
    const Forest& forest() const { return forest_; }
    // The rows; none where shots are on the fly.
    const ExchangeAreas& areas(std::size_t band) const { return rows_->areas[matrix_[band]]; }
    // Those of each distinct extinction; to be used again as `made`.
    const std::shared_ptr<const RowSet>& rows() const { return rows_; }
    // S_i,out [m^2].
    double to_outside(std::size_t element, std::size_t band) const;
    // max_i |Σ_j S_ij − c_i| / c_i of the rows that are kept, or have been made so far [-].
    double closure_error(std::size_t band) const;
    // Of the rows; NaN where none are kept: shots on the fly take S_ji to be S_ij [-].
    double reciprocity_error(std::size_t band) const;
    std::size_t rays() const { return rays_; }            // walked so far
    std::size_t lost_rays() const { return lost_rays_; }  // of them, by the walk's step cap
    std::size_t memory() const;

    // Solves for r given H^A of every element ([element * bands + band]):
    //   r = e^R + a (H^A + S r / c),
    // and for the emission of elements that settle (44), if there are any. e^R leaves out what
    // direct light counts in closed form. On the fly a stop asked for leaves what there was before,
    // or a first solution as far as it came. With `incident_lit`, H from what patches reflect of
    // direct light, r leaves that out of what is sent through the rows: it has arrived already.
    void solve(const std::vector<double>& incident_direct,
               const std::vector<double>& incident_lit = {});

    // Purpose: the error of what is gathered from this solution, given the error that a finer
    // gather finds in its H (`departure`: H − finer H, [element * bands + band]). To first order
    //   δx = a (departure + S δx / c),  δH = S δx / c:                               (29)
    // the departure sent through the rows, once and again.
    std::vector<double> carried(const std::vector<double>& departure) const;

    // e of an element: its own, or what it settles to (settled_emission.h) [W/m^2/sr].
    double emission(std::size_t element, std::size_t band) const {
        return elements_.emission[element * elements_.bands + band] +
               settled_.emission(element, band);
    }
    const SettledEmission& settled() const { return settled_; }

    const SolverReport& report() const { return solved_.report; }
    // S r / c with outside: the indirect part of H, and r itself [W/m^2/sr].
    double indirect(std::size_t element, std::size_t band) const {
        return solved_.indirect[element * elements_.bands + band];
    }
    // The same in all its elements, linear where the solution is: each element's mean kept, no
    // value at a corner below 0 ([element * bands + band]).
    std::vector<Affine> linear_indirect() const;
    double reflected(std::size_t element, std::size_t band) const {
        return solved_.reflected[element * elements_.bands + band];
    }
    // The part of `indirect` that rows bring, outside's included [W/m^2/sr].
    double by_rows(std::size_t element, std::size_t band) const {
        return solved_.by_rows[element * elements_.bands + band];
    }
    // Of the rays that rows were made of (exchange_moved.h).
    std::vector<glm::vec3> ray_directions() const;
    // Σ c r² over Σ c, of all bands [(W/m^2/sr)^2].
    double mean_square() const;
    // e^A: emission counted in closed form, of sides that shine; 0 else.
    double split_emission(std::size_t element, std::size_t band) const;

    ElementValues values(const std::vector<double>& incident_direct) const;

  private:
    struct Solved {
        std::vector<double> indirect, reflected, by_rows;  // [element * bands + band] [W/m^2/sr]
        SolverReport report;
    };

    bool on_the_fly() const { return options_.shots == Shots::on_the_fly; }
    ExchangeOptions exchange_options(std::size_t band) const;
    void make_areas(std::span<const std::size_t> bands, const KeptRows* kept, RowSet& rows);
    void make_rows(std::size_t band, std::span<const ElementId> rows, const RowSink& sink) const;
    void make_in_mirrors(std::span<const std::size_t> bands, RowSet& rows);
    void find_outside(std::size_t band);
    SolverResult solve_band(std::size_t band, std::span<const double> source,
                            const NamedSolver& solver, const SolverOptions& options) const;
    static void add_to_report(const SolverResult& result, SolverReport& report);
    bool add_band(std::size_t band, const std::vector<double>& incident_direct,
                  const std::vector<double>& incident_lit, Solved& solved) const;
    void solve_bands(const std::vector<double>& incident_direct,
                     const std::vector<double>& incident_lit);
    double lit_scale(const std::vector<double>& incident_direct,
                     const std::vector<double>& incident_lit, std::span<const double> in_mirrors,
                     std::size_t band) const;
    std::vector<double> arrived_apart(std::size_t band, const std::vector<double>& incident_direct,
                                      const std::vector<double>& incident_lit) const;
    std::vector<double> in_mirrors(std::span<const double> sent, std::size_t band) const;

    const Enclosure& enclosure_;
    const Forest& forest_;
    Forest at_first_;  // as it was when the elements were its leaves, for rows on the fly
    SolveOptions options_;
    ProgressCallback progress_;
    Elements elements_;
    SettledEmission settled_;
    std::shared_ptr<const RowSet> rows_;
    std::vector<std::size_t> matrix_;  // which of the rows a band uses
    // Of each of the rows: S_i,out of every element; on the fly nothing if the scene is closed
    // [m^2].
    std::vector<std::vector<double>> outside_;
    mutable std::vector<double> closure_;  // of each of the rows, of those made so far on the fly
    Solved solved_;
    std::vector<double> guess_;  // KeptRows::sent; empty: none
    mutable std::size_t rays_ = 0;
    mutable std::atomic<std::size_t> lost_rays_ = 0;
};

}  // namespace tyndall::radiosity
