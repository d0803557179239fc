// Pictures by following light paths alone: the oracle of all other renderers.
#pragma once

#include "radiosity/progress.h"
#include "radiosity/solution.h"
#include "render/camera.h"
#include "render/image.h"
#include "render/options.h"

namespace tyndall::render {

// Purpose: a picture of a scene, unbiased, with nothing of a solution in it: no elements, no
// exchange
//   areas, no walk through tetrahedra. Layers as line_of_sight has them, whose oracle they are, and
//   "error", the standard error of each pixel [W/m²/sr]; with mirrors or glossy surfaces also
//   specular_reflection.
// Method: LightPaths; goals: sampled_picture (samples, error, time). Media have the scattering
//   coefficients and phase functions of the scene file, not the reduced ones of a solve.
// Errors: mesh::InputError for a camera inside a solid, for heat in several bands, and for
//   bodies (renderers.h).
// Cost: about 5 µs a path in a room. Error: samples^−1/2.
// Source: Kajiya (1986); see light_paths.h.
Image path_traced(const radiosity::Enclosure& enclosure, const Camera& camera,
                  const RenderOptions& options = {},
                  const radiosity::ProgressCallback& progress = {});

// Of the scene that a solution is of.
Image path_traced_scene(const radiosity::Solution& solution, const Camera& camera,
                        const RenderOptions& options, const radiosity::ProgressCallback& progress);

}  // namespace tyndall::render
