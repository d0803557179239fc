// The light of a solution that arrives in a medium, by the directions it comes from.
#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "radiosity/cube_faces.h"
#include "radiosity/gather.h"
#include "radiosity/solution.h"
#include "render/spherical_harmonics.h"

namespace tyndall::render {

struct ArrivingLightOptions {
    std::size_t resolution = 16;  // pixels along an edge of the cubes
    // Zones stand together in nodes of the forest whose longest edge is below this share of their
    // medium's diagonal; leaves that are larger stand alone [-].
    double group = 0.12;
    double series = 0.01;         // of phase functions: what their series leaves out of g^l [-]
    std::size_t most_order = 12;  // of harmonics, whatever that says
};

// Coefficients of a phase function in Legendre polynomials, Φ = Σ (2l + 1)/(4π) f_l P_l(cosθ):
//   g^l of Henyey–Greenstein, 1, 0, 1/10 of Rayleigh. (57)
double phase_coefficient(const radiosity::PhaseFunction& phase, std::size_t l);

// Purpose: what a phase function makes of the radiance L that arrives at a place, over what even
//   scattering makes of it, for any direction:
//     q(x, ω) = 4π ∫ Φ(ω·ω_i) L(x, ω_i) dω_i / ∫ L dω_i = Σ_l f_l Σ_m c_lm(x) Y_lm(ω)          (57)
//   L holds all that zones and patches send out but for what counts as direct light, and the
//   environment: walked along (4) through reduced extinction, as the solve has it.
// Method: a full cube at the corners of nodes; c_lm is the sum over its pixels of L times the
//   pixel's ∫ Y_lm dω, over their mean L. In between both integrals are linear. So one cube serves
//   all directions that a picture, or several, see it from. Where L is nothing, q = 1.
// Cubes are made when they are first asked for. Cost: 6 resolution² walks each. Memory: (order +
// 1)²
//   numbers a band each.
// Source: Rushmeier (1991), whose cube is turned to the eye and weighed by Φ.
class ArrivingLight {
  public:
    // Keeps a reference to the solution. Media that scatter evenly have no cubes.
    explicit ArrivingLight(const radiosity::Solution& solution,
                           const ArrivingLightOptions& options = {});

    // Of harmonics; 0: every medium scatters evenly.
    std::size_t order() const { return order_; }
    // Whether a node's corners have cubes: to descend to.
    bool group(mesh::ZoneId zone) const { return group_of_[zone.value] != radiosity::none; }

    // f_l Y_lm(ω) of a medium, for `shares`; ω the direction of a ray from the eye.
    void weigh(std::uint32_t medium, mesh::Direction direction, std::vector<double>& weights) const;
    // q at two points of a node, one value a band each; never below 0. Thread-safe; depends on its
    // arguments alone.
    void shares(mesh::ZoneId group, std::span<const double> weights, mesh::Point a, mesh::Point b,
                std::span<double> at_a, std::span<double> at_b) const;

    // Where cubes stand, and the mean of what arrives there, one value a band [W/m^2/sr].
    std::size_t cube_count() const { return cubes_.size(); }
    mesh::Point place(std::size_t cube) const { return cubes_[cube]->x; }
    std::span<const double> mean(std::size_t cube) const;

  private:
    struct Cube {
        mesh::Point x{0.0};
        mesh::TetId tet;
        std::once_flag made;
        std::vector<double> mean, moments;  // a band; [band * count + lm]
    };

    class Grouping;

    void weigh_pixels(std::size_t resolution);
    const Cube& made(std::uint32_t cube) const;
    void make(Cube& cube) const;

    const radiosity::Solution& s_;
    const radiosity::Enclosure& e_;
    std::size_t bands_, order_ = 0;
    radiosity::GatherScene scene_;
    std::vector<std::uint32_t> group_of_;                // of zone nodes; none
    std::vector<std::array<std::uint32_t, 4>> corners_;  // of groups: cubes
    std::vector<std::unique_ptr<Cube>> cubes_;
    struct Pixel {
        mesh::Direction direction;
        double share;  // of all directions [-]
    };
    std::vector<Pixel> pixels_;
    std::vector<double> harmonics_;  // ∫ Y_lm dω, [pixel * count + lm]
};

}  // namespace tyndall::render
