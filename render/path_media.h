// Media as paths meet them: with the coefficients they have, not the reduced ones of the solve.
#pragma once

#include <span>
#include <vector>

#include "radiosity/facet_hits.h"
#include "render/random_numbers.h"

namespace tyndall::render {

using mesh::Direction;
using mesh::Point;
using radiosity::Spectrum;
using radiosity::Stretch;

// A ray with what it passes.
struct PassedRay {
    Point origin{0.0};
    Direction direction{0.0};
    std::span<const Stretch> stretches{};

    Point at(double t) const { return origin + t * direction; }
};

// Those a medium has, or those that the isotropic solve gives it.
enum class Coefficients { whole, reduced };

// Where a path scatters, or not.
struct Collision {
    bool scattered = false;  // else it goes through to the end
    double distance = 0.0;   // [m]
    std::uint32_t medium = radiosity::none;
    double density = 0.0;  // of scattering here [1/m], or probability of going through [-]
};

// Purpose: extinction, scattering and emission along rays; places where paths scatter.
// Equations: κ_t = κ_a + κ_s with κ_s unreduced. A medium with given heat gives back what it
//   absorbs, evenly: κ_s Φ + κ_a/(4π) then stands for κ_s Φ.
// Optical depths are exact, where κ_t varies as well (regular_grid.h): nothing is marched.
class PathMedia {
  public:
    // Errors: mesh::InputError for heat in several bands, whose temperatures only a solve finds,
    //   and for bodies (renderers.h).
    explicit PathMedia(const radiosity::Enclosure& enclosure);

    std::size_t bands() const { return bands_; }
    // κ_t [1/m].
    double extinction(std::uint32_t medium, std::size_t band, Point x) const;
    // Optical depth of a part of a ray in one medium [-].
    double depth(const PassedRay& ray, std::uint32_t medium, std::size_t band, double begin,
                 double end) const;
    // Of all stretches up to `end`, one value a band [-].
    void transmittance(const PassedRay& ray, double end, std::span<double> result,
                       Coefficients coefficients = Coefficients::whole) const;

    // Adds what media emit along the whole ray, as it arrives at its origin, times `weight`
    // [W/m²/sr].
    void add_emission(const PassedRay& ray, std::span<const double> weight,
                      std::span<double> radiance) const;

    // Scattered share of extinction, per solid angle: (κ_s Φ + κ_re/4π) / κ_t [1/sr].
    double scattered(std::uint32_t medium, std::size_t band, double cosine) const;
    // The same over all directions [-].
    double albedo(std::uint32_t medium, std::size_t band) const;
    // κ_re / κ_t: the part of it that a medium with given heat gives back, evenly [-].
    double given_back(std::uint32_t medium, std::size_t band) const;
    // Of the directions that sample_direction draws [1/sr].
    double direction_density(std::uint32_t medium, double cosine) const;
    Direction sample_direction(std::uint32_t medium, Direction before, RandomNumbers& random) const;

    // Purpose: a collision with density Σ_b q_b κ_b T_b, or going through with probability
    //   Σ_b q_b T_b, for shares q of the bands that add up to 1; from two numbers in [0, 1).
    Collision sample(const PassedRay& ray, std::span<const double> shares, double u,
                     double v) const;
    // That density at a distance on the ray [1/m].
    double density(const PassedRay& ray, double distance, std::span<const double> shares) const;
    // A collision in any case: with density Σ_b q_b κ_b T_b / (1 − T_b(end)). Not scattered: there
    // is nothing on the way.
    Collision sample_within(const PassedRay& ray, std::span<const double> shares, double u,
                            double v) const;
    double density_within(const PassedRay& ray, double distance,
                          std::span<const double> shares) const;

    // All media scatter evenly.
    bool isotropic() const { return isotropic_; }

  private:
    struct Optics {
        Spectrum extinction;    // κ_t; where it varies: its mean [1/m]
        Spectrum albedo;        // (κ_s + κ_re) / κ_t [-]
        Spectrum given_back;    // κ_re / κ_t [-]
        Spectrum emission;      // what is emitted, over κ_t [W/m^2/sr]
        Spectrum over_reduced;  // κ_t over the reduced one [-]
        radiosity::PhaseFunction phase;
        double isotropic_share = 0.0;  // of sampled directions [-]
        const std::vector<radiosity::ExtinctionBand>* varying = nullptr;
    };

    double all_depth(const PassedRay& ray, std::size_t band) const;
    Collision place(const PassedRay& ray, std::size_t band, double depth) const;
    // Weighs each band's density by `weight(band)`.
    template <class Weight>
    double mixed_density(const PassedRay& ray, double distance, Weight&& weight) const;
    double invert(const PassedRay& ray, const Stretch& stretch, std::size_t band,
                  double depth) const;

    std::size_t bands_;
    std::vector<Optics> optics_;
    bool isotropic_ = true;
};

}  // namespace tyndall::render
