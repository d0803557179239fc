// Pictures in two passes: light paths for what is near the eye, a solution for all the rest.
#pragma once

#include "radiosity/progress.h"
#include "radiosity/solution.h"
#include "render/camera.h"
#include "render/image.h"
#include "render/options.h"

namespace tyndall::render {

// Purpose: a picture that is right where a solution's elements are not: direct light with its exact
//   shadows on surfaces and along rays, contact shadows by one gathered ray a sample, mirrors and
//   glossy surfaces, phase functions. Layers as path_traced has them, "error" too, which knows of
//   the samples' noise alone: the solution's error is not in it.
// Method: Where all media scatter evenly and nothing is specular: the ray from the eye gains
//   emission and multiple scattering of the solution's zones in closed form (25), single scattering
//   from two places with direct light in closed form (18) to (20), drawn by transmittance and
//   equiangularly (53); what it ends on has direct light in closed form and one ray of the rest
//   gathered. Else: LightPaths, handed over to the solution at the scattering `options.scatterings`
//   (0: 1 where media scatter evenly, 3 where not), where direct light goes through reduced
//   extinction and the rest is gathered along one ray. Where media do not scatter evenly, what
//   arrives on the surface seen is direct light in closed form, by the extinction as it is, and a
//   path through them to the next surface, whose light is the solution's. (60)
// Errors: mesh::InputError for a camera inside a solid, for heat in several bands, and for
//   bodies (renderers.h).
// Cost: about 10 µs a sample in a room.
// Source: Chen, Rushmeier, Miller & Turner (1991); Rushmeier (1991).
Image two_pass(const radiosity::Solution& solution, const Camera& camera,
               const RenderOptions& options = {}, const radiosity::ProgressCallback& progress = {});

}  // namespace tyndall::render
