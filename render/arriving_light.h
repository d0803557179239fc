// The light of a solution that arrives in a medium and on surfaces, by the directions it comes
// from.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "radiosity/cube_faces.h"
#include "radiosity/progress.h"
#include "radiosity/solution.h"
#include "render/arriving_places.h"
#include "render/spherical_harmonics.h"
#include "render/turned_sources.h"

namespace tyndall::render {

struct ArrivingLightOptions {
    std::size_t resolution = 12;  // pixels along an edge of the cubes
    // Pixels from where zones send more than this times the mean of all directions, having turned
    // direct light there, are divided so that none of their parts is worth more; 0: none is [-].
    double brightest = 1.5;
    ArrivingPlacesOptions places{};
    double series = 0.01;         // of phase functions: what their series leaves out of g^l [-]
    std::size_t most_order = 12;  // of harmonics, whatever that says
    std::size_t sweeps = 2;       // source iterations beyond the solution's own light
};

// Coefficients of a phase function in Legendre polynomials, Φ = Σ (2l + 1)/(4π) f_l P_l(cosθ):
//   g^l of Henyey–Greenstein, 1, 0, 1/10 of Rayleigh. (57)
double phase_coefficient(const radiosity::PhaseFunction& phase, std::size_t l);

// Purpose: what a phase function makes of the radiance L that arrives at a place, over what even
//   scattering makes of the solution's, for any direction:
//     q(x, ω) = 4π ∫ Φ(ω·ω_i) L(x, ω_i) dω_i / ∫ L⁰ dω_i = Σ_l f_l Σ_m c_lm(x) Y_lm(ω)         (57)
//   and what L is beyond the solution's on a surface:
//     δ(x) = ∫ (L − L⁰) cosθ dω / π                                                            (62)
//   L⁰ holds all that zones and patches send out but for what counts as direct light, and the
//   environment, walked along (4) through reduced extinction, as the solve has it. Each sweep of
//   source iteration walks again, through whole extinction, with what the zones scatter in the
//   direction of the ray (61), as the sweep before has it, and what the patches reflect of that.
// Method: a full cube at the corners of nodes, the same directions in all: they are walked one
//   after the other, from all places, so that J is made for one direction at a time. c_lm is the
//   sum over a cube's pixels of L times the pixel's ∫ Y_lm dω, over the mean L⁰. In between both
//   integrals are linear, and δ is. Where L⁰ is nothing, q = 1.
// Cost: a walk a place, pixel and sweep (half of them on surfaces), and one more sweep for L⁰.
//   There are about 1500 pixels: 6 resolution², and what bright ones are divided into. Memory: 4
//   bytes a place, pixel and band meanwhile; (order + 1)² numbers a place and band then.
// Same bits at any thread count.
// Source: Rushmeier (1991), whose cube is turned to the eye and weighed by Φ; source iteration on
//   discrete ordinates: Chandrasekhar (1950), Lewis & Miller (1984), Languénou, Bouatouch & Chelle
//   (1994).
class ArrivingLight {
  public:
    // Keeps a reference to the solution. Media that scatter evenly have no cubes.
    explicit ArrivingLight(const radiosity::Solution& solution,
                           const ArrivingLightOptions& options = {},
                           const radiosity::ProgressCallback& progress = {});

    // Of harmonics; 0: every medium scatters evenly.
    std::size_t order() const { return order_; }
    // Whether a node's corners have cubes: to descend to.
    bool group(mesh::ZoneId zone) const {
        return places_.zone_groups[zone.value] != radiosity::none;
    }

    // f_l Y_lm(ω) of a medium, for `shares`; ω the direction of a ray from the eye.
    void weigh(std::uint32_t medium, mesh::Direction direction, std::vector<double>& weights) const;
    // q at two points of a node, one value a band each; never below 0.
    void shares(mesh::ZoneId group, std::span<const double> weights, mesh::Point a, mesh::Point b,
                std::span<double> at_a, std::span<double> at_b) const;
    // δ at a point of a facet's side, one value a band [W/m^2/sr].
    void beyond(mesh::FacetId facet, mesh::Side side, mesh::Point x, std::span<double> more) const;

    // Where cubes stand, and the mean of what arrives there, one value a band [W/m^2/sr].
    std::size_t cube_count() const { return places_.in_media; }
    mesh::Point place(std::size_t cube) const { return places_.places[cube].x; }
    std::span<const double> mean(std::size_t cube) const { return {&mean_[cube * bands_], bands_}; }

    const PathMedia& media() const { return media_; }
    const radiosity::Enclosure& whole() const { return whole_; }
    // What zones make of light; null: every medium scatters evenly.
    const TurnedSources* sources() const { return sources_.get(); }

  private:
    struct Pixel {
        mesh::Direction direction;
        double share;  // of all directions [-]
    };

    void weigh_pixels(const ArrivingLightOptions& options);
    void add_pixel(const radiosity::CubeFace& face, std::size_t i, std::size_t j,
                   std::size_t parts);
    void place_leaves();
    bool look(std::size_t sweep, const radiosity::GatherScene& scene,
              const std::function<bool(double)>& tell, std::vector<float>& radiance) const;
    void keep(std::size_t sweep, const std::vector<float>& radiance);
    void turn_sources(Direction direction, std::vector<float>& indirect) const;
    void reflect(radiosity::GatherScene& scene) const;

    const radiosity::Solution& s_;
    const radiosity::Enclosure& e_;
    const radiosity::Enclosure whole_;
    PathMedia media_;
    std::size_t bands_, order_ = 0;
    ArrivingPlaces places_;
    std::unique_ptr<const TurnedSources> sources_;
    std::vector<std::array<float, 4>> leaf_weights_;  // of corners, at centroids of places_.zones
    std::vector<Pixel> pixels_;
    std::vector<double> harmonics_;  // ∫ Y_lm dω, [pixel * count + lm]
    // Of cubes: mean L⁰ [place * bands + band], c_lm [(place * bands + band) * count + lm].
    std::vector<double> mean_, moments_;
    std::vector<double> irradiance_, beyond_;  // of L⁰ over π, and δ, of places on surfaces
};

}  // namespace tyndall::render
