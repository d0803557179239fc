// The coarse solution: rows of exchange areas kept, solved again whenever direct light is known
// better.
#pragma once

#include "radiosity/options.h"
#include "radiosity/settled_emission.h"
#include "radiosity/solution.h"
#include "radiosity/solver.h"

namespace tyndall::radiosity {

class CoarseSolution {
  public:
    // The elements are the forest's leaves now; rows are made here, once a distinct extinction.
    CoarseSolution(const Enclosure& enclosure, const Forest& forest, const SolveOptions& options,
                   const ProgressCallback& progress);
    // With elements of the caller's, clusters for instance.
    CoarseSolution(const Enclosure& enclosure, const Forest& forest, Elements elements,
                   const SolveOptions& options, const ProgressCallback& progress);

    const Elements& elements() const { return elements_; }
    const Forest& forest() const { return forest_; }
    const ExchangeAreas& areas(std::size_t band) const { return areas_[matrix_[band]]; }
    std::size_t rays() const { return rays_; }
    std::size_t lost_rays() const { return lost_rays_; }  // of them, by the walk's step cap
    std::size_t memory() const;

    // Solves for r given H^A of every element ([element * bands + band]):
    //   r = e^R + a (H^A + S r / c),
    // and for the emission of elements that settle (40), if there are any.  e^R leaves out what
    // direct light counts in closed form. With `incident_lit`, H from what patches reflect of
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

    const SolverReport& report() const { return report_; }
    // S r / c with outside: the indirect part of H, and r itself [W/m^2/sr].
    double indirect(std::size_t element, std::size_t band) const {
        return indirect_[element * elements_.bands + band];
    }
    // The same in all its elements, linear where the solution is: each element's mean kept, no
    // value at a corner below 0 ([element * bands + band]).
    std::vector<Affine> linear_indirect() const;
    double reflected(std::size_t element, std::size_t band) const {
        return reflected_[element * elements_.bands + band];
    }
    // e^A: emission counted in closed form, of sides that shine; 0 else.
    double split_emission(std::size_t element, std::size_t band) const;

    ElementValues values(const std::vector<double>& incident_direct) const;

  private:
    void solve_bands(const std::vector<double>& incident_direct,
                     const std::vector<double>& incident_lit);
    double lit_scale(const std::vector<double>& incident_direct,
                     const std::vector<double>& incident_lit, std::size_t band) const;

    const Enclosure& enclosure_;
    const Forest& forest_;
    SolveOptions options_;
    Elements elements_;
    SettledEmission settled_;
    std::vector<ExchangeAreas> areas_;
    std::vector<std::size_t> matrix_;  // which of areas_ a band uses
    std::vector<double> indirect_, reflected_;
    SolverReport report_;
    std::size_t rays_ = 0;
    std::atomic<std::size_t> lost_rays_ = 0;
};

}  // namespace tyndall::radiosity
