// The lobe of a rough mirror: microfacets, with the light that they pass on among each other.
#pragma once

#include <vector>

#include "mesh/types.h"

namespace tyndall::render {

// Purpose: a reflectance distribution about the mirror direction that gives back all light,
// whatever
//   the direction it comes from: what a surface of specular reflectance ρ_s is ρ_s times of.
// Equation: f = D G₂ / (4 |cosθ_o cosθ_i|) + (1−E(θ_o)) (1−E(θ_i)) / (π (1 − ⟨E⟩))            (52)
//   D of Trowbridge & Reitz with α = roughness², G₂ Smith's, E(θ) = ∫ first term cosθ_i dω_i and
//   ⟨E⟩ = 2 ∫ E cosθ d(cosθ). The second term is what the facets reflect more than once.
// Valid for: α > 0. A roughness below 0.03 counts as 0.03: a lobe of 0.05°.
// Accuracy: E is tabulated; f loses and gains at most 2e-3 of the light that falls on it.
// Cost: the table once, some 10 ms.
// Source: Walter et al. (2007); Heitz (2014, 2018: visible normals); Kulla & Conty (2017).
class GlossyLobe {
  public:
    explicit GlossyLobe(double roughness);

    // f for unit directions away from the surface, z along the normal [1/sr].
    double value(mesh::Direction out, mesh::Direction in) const;
    // An `in` for an `out` from three numbers in [0, 1), and how densely it is chosen; it may lie
    // below the surface: then it carries nothing.
    mesh::Direction sample(mesh::Direction out, double choice, double u, double v) const;
    double density(mesh::Direction out, mesh::Direction in) const;

    // E of a cosine [-].
    double single(double cosine) const;

  private:
    double facets(mesh::Direction out, mesh::Direction in) const;

    double alpha_;
    std::vector<double> single_;  // E over cosines, even steps in their square root
    double mean_single_ = 1.0;    // ⟨E⟩
};

}  // namespace tyndall::render
