// Pictures by the line of sight: the walk along every pixel's ray with linear or quadratic J in
// closed form.
#pragma once

#include "radiosity/progress.h"
#include "radiosity/solution.h"
#include "render/camera.h"
#include "render/image.h"
#include "render/options.h"

namespace tyndall::render {

// Purpose: a picture of a solution, with the parts that make it up as layers:
//   beauty = emission + surfaces_direct + surfaces_indirect + single_scattering +
//   multiple_scattering (+ specular_reflection, all that mirrors show at which walks go on (64))
//   and transmittance (of the medium in front of what is seen), depth [m] (infinity: nothing hit).
// Equation: I = Σ_segments T ∫ κ e^{−κs} J ds + T I_surface, J and I linear or quadratic in each
// leaf. (4), (68) Anti-aliased: `samples` rays a pixel, a scrambled (0,2)-net, box filter of one
// pixel; one through
//   its middle where radiance is linear from there to the neighbours' (`contrast`).
// Indirect light of surfaces: the patches' functions, or gathered right there
//   (`final_gather`, final_gather.h).
// A camera outside the hull looks in through it. Radiances are never negative.
// Errors: mesh::InputError for a camera inside a solid.
// Cost: leaves crossed × rays, and with them × final_gather / samples. Same bits at any thread
// count.
Image line_of_sight(const radiosity::Solution& solution, const Camera& camera,
                    const RenderOptions& options = {},
                    const radiosity::ProgressCallback& progress = {});

}  // namespace tyndall::render
