// Walls and media whose temperature settles by the heat they get, in several bands: what they emit
// in each band is found with the solution.
#pragma once

#include <functional>

#include "radiosity/elements.h"

namespace tyndall::radiosity {

struct SettleOptions {
    double tolerance = 1e-6;       // |G(R) − R| / |R| [-]
    std::size_t iterations = 100;  // at most
};

struct SettleResult {
    std::size_t iterations = 0;
    double residual = 0.0;  // |G(R) − R| / |R| [-]
    bool converged = false;
};

// The elements of sides with a settled flux and of media with a settled heat. What such an element
// takes up in all bands it emits again, in the shares of its own temperature:
//   R = q/π + Σ_b ε_b H_b,                e_b = ε_b f_b(T) σT⁴/π             of a patch
//   R = Q/4π + Σ_b κ_a,b H_b,   κ_t,b e_b = κ_a,b f_b(T) σT⁴/π             of a zone     (44)
// with T such that the emissions add up to R (42).
class SettledEmission {
  public:
    SettledEmission(const Enclosure& enclosure, const Forest& forest, const Elements& elements);

    bool empty() const { return elements_.empty(); }

    // e_b of an element as it was found; 0 of elements that do not settle [W/m^2/sr].
    double emission(std::size_t element, std::size_t band) const {
        return emission_.empty() ? 0.0 : emission_[element * bands_ + band];
    }
    // q A, or Q V: heat that is brought in from beyond the solution; 0 of all others [W].
    double heat(std::size_t element) const { return heat_.empty() ? 0.0 : heat_[element]; }

    // H of every element ([element * bands + band]) when all emit as `emission` says.
    using Incident = std::function<std::vector<double>()>;

    // Purpose: R such that R = G(R), with G: emit by R, solve every band, add up what is taken up.
    //   With the shares held G would be linear; Anderson's mixing of the last ten steps then makes
    //   the same approximations as GMRES, and the shares follow on the way. Begins with what was
    //   found before. Leaves the emission of the last solve in `emission`.
    // Cost: a solve of every band each iteration, 5 to 20 of them, more in optically thick media.
    // Source: Anderson (1965); Walker & Ni (2011).
    SettleResult settle(const Incident& incident, const SettleOptions& options);

  private:
    void emit(const std::vector<double>& taken);
    std::vector<double> taken(const std::vector<double>& incident) const;

    const SpectralModel& model_;
    std::size_t bands_;
    std::vector<std::size_t> elements_;
    std::vector<double> absorbs_;          // ε_b, κ_a,b of these, a band each
    std::vector<double> per_;              // 1, or κ_t,b
    std::vector<double> source_;           // q/π, or Q/4π
    std::vector<double> weights_;          // of their squares in |R|: their areas and 4 × volumes
    std::vector<double> taken_;            // R
    std::vector<double> emission_, heat_;  // of all elements
};

}  // namespace tyndall::radiosity
