// Pictures by the last scattering: what a solution sends through a medium, turned to the eye by the
// medium's phase function.
#pragma once

#include "radiosity/progress.h"
#include "radiosity/solution.h"
#include "render/camera.h"
#include "render/image.h"
#include "render/options.h"

namespace tyndall::render {

// Purpose: a picture of a solution in which the scatterings nearest to the eye have their phase
//   function and whole coefficients. Layers as line_of_sight has them, and "error", the samples'
//   own noise (sampled_picture.h); what the solution is off by is not in it.
// Equations: along a ray from the eye in direction ω, with κ, Ω, Φ, T as they are (not reduced),
//     multiple_scattering: ∫ T κ Ω q H^I dt                                                    (58)
//     single_scattering:   ∫ T κ Ω ∫ Φ τ L^A dω dt
//   H^I the leaf's, q of (57) after two steps of source iteration (60) (arriving_light.h), L^A what
//   lights send, τ the transmittance on the way from them. Surfaces are seen through T: direct
//   light anew by τ in closed form, indirect light the leaf's and δ (62).
// What comes from lights is what the leaves hold, turned to the eye (61), and at two places a
//   sample, drawn by T and equiangularly (53), what they depart by from the visible parts of all
//   lights in closed form: shafts are as sharp as the light makes them, whatever the mesh. The rest
//   is without noise.
// Where media scatter evenly q = 1, δ = 0, and the picture is line_of_sight's but for single
//   scattering.
// Limits: harmonics up to order 12, cubes at some distance of each other (docs/limits.md).
// Errors: mesh::InputError for a camera inside a solid, for heat in several bands, and for
//   bodies (renderers.h).
// Cost: two places with direct light a sample; before that, where media do not scatter evenly, what
//   arriving_light.h says.
// Same bits at any thread count.
// Source: Rushmeier (1991), directional step; Lewis & Miller (1984), source iteration; Kulla &
//   Fajardo (2012).
Image last_scatter(const radiosity::Solution& solution, const Camera& camera,
                   const RenderOptions& options = {},
                   const radiosity::ProgressCallback& progress = {});

}  // namespace tyndall::render
