// Pictures by the last scattering: what a solution sends through a medium, turned to the eye by the
// medium's phase function.
#pragma once

#include "radiosity/progress.h"
#include "radiosity/solution.h"
#include "render/camera.h"
#include "render/image.h"
#include "render/options.h"

namespace tyndall::render {

// Purpose: a picture of a solution in which the scattering that sends light to the eye, and no
//   other, has its phase function and whole coefficients. Layers as line_of_sight has them, and
//   "error", the samples' own noise (sampled_picture.h); what the solution is off by is not in it.
// Equations: along a ray from the eye in direction ω, with κ, Ω, Φ, T as they are (not reduced),
//     multiple_scattering: ∫ T κ Ω (q H^I + ∫ Φ (τ_r − τ) L^A dω) dt                           (58)
//     single_scattering:   ∫ T κ Ω ∫ Φ τ L^A dω dt
//   H^I the leaf's, q of (57); L^A what lights send, τ the transmittance on the way from them, τ_r
//   the same by the reduced coefficients of the solve: what is between the two was turned forwards
//   on its way, and still comes from where the light is. Surfaces as line_of_sight has them, seen
//   through T.
// What comes from lights is taken at two places a sample, drawn by T and equiangularly (53), from
//   the visible parts of all lights in closed form: shafts are as sharp as the light makes them,
//   whatever the mesh. The rest is without noise.
// Where media scatter evenly q = 1 and τ_r = τ, and the picture is line_of_sight's but for single
//   scattering.
// Limits: one scattering has its direction. Light that was turned forwards several times is taken
//   for evenly scattered, or for light straight from the lamp (docs/limits.md).
// Errors: mesh::InputError for a camera inside a solid, for heat in several bands, and for
//   bodies (renderers.h).
// Cost: two places with direct light a sample; 6 · 16² walks, 2 ms, for each of up to some
//   thousand places.
// Same bits at any thread count.
// Source: Rushmeier (1991), directional step; Kulla & Fajardo (2012).
Image last_scatter(const radiosity::Solution& solution, const Camera& camera,
                   const RenderOptions& options = {},
                   const radiosity::ProgressCallback& progress = {});

}  // namespace tyndall::render
