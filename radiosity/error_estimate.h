// What a solution may be wrong by, leaf by leaf, and what that does to it and to its picture.
#pragma once

#include "radiosity/leaf_light.h"
#include "radiosity/view.h"

namespace tyndall::radiosity {

// Errors of the leaves' H by their causes, which do not know of each other [W/m^2/sr].
struct LeafErrors {
    // Departures from what the leaves hold, root mean squares, by node. Of either sign: those of
    // different leaves are taken for independent.
    std::vector<float> zone_elements, patch_elements;
    std::vector<float> patch_direct;  // the part of patch_elements that is of direct light
    // With their sign, since neighbours share them: what one throw of the gathers' noise looks
    // like, and what is carried into the gathers from the coarse solution.
    Fields gathers, coarse;
};

// Purpose: the error that coarse elements have in what is gathered from them: H of each less the
// mean over it of `gathered`, the leaves' indirect light, the level difference, and the difference
// of two rules for the mean of direct light, sent on through the rows (CoarseSolution::carried)
// [element * bands + band] [W/m^2/sr].
// Cost: one more solution of the linear system, to 1 %.
std::vector<double> coarse_errors(const ElementMesh& mesh, DirectRefiner& direct,
                                  const LeafLight& leaf_light, const CoarseSolution& coarse,
                                  const Fields& gathered);

// Purpose: all of that, of the leaves of a mesh whose gathers are made; `coarse_errors`: of the
// elements of `coarse`.
//   elements: departures that refinement has left (DirectRefiner, IndirectRefiner), and the
//     difference of two rules for the mean of direct light; where elements are constant, their own
//     variation too
//   gathers: half the difference of two halves of the rays, times 2^(−1/6)
//   coarse: those of the elements
// Cost: O(leaves).
LeafErrors leaf_errors(const Enclosure& enclosure, ElementMesh& mesh, DirectRefiner& direct,
                       IndirectRefiner& indirect, LeafLight& leaf_light,
                       const CoarseSolution& coarse, const std::vector<double>& coarse_errors,
                       Radiance radiance);

// Fills in the errors of a solution's leaves (of x, from those of H), and the relative errors of
// its report: of the solution, and of the picture where there is a view.
void estimate_errors(const LeafErrors& errors, const std::optional<View>& view, Solution& solution);

// Purpose: the relative root mean square error of a pixel, by causes. Where noise and the coarse
// solution's error have a sign, it is what the picture of them shows; departures of leaves add
// their squares along a ray:
//   e² = ⟨ε_g² + ε_c² + Σ_leaves (T w a δ)²⟩ / L²,  L the picture's mean radiance            (30)
// Direct light on surfaces is left out: pictures compute it anew.
// Cost: 64 × 48 rays. Nothing where no ray of the view enters the scene, or all of them are dark.
std::optional<ErrorParts> picture_error(const Solution& solution, const LeafErrors& errors,
                                        const View& view);

// L of (30), a value a band [W/m^2/sr]. Cost: 64 × 48 rays a band.
Spectrum picture_radiance(const Solution& solution, const View& view);

}  // namespace tyndall::radiosity
