// Pictures by projection: an item buffer of the surfaces, and the zones laid over it one by one.
#pragma once

#include "radiosity/progress.h"
#include "radiosity/solution.h"
#include "render/camera.h"
#include "render/image.h"
#include "render/options.h"

namespace tyndall::render {

// Purpose: a picture of a solution with the layers of line_of_sight.h, without following a ray.
//   Patches are drawn into a z-buffer that keeps which patch a pixel shows. The front and back
//   faces of every zone are projected; at each pixel they give where its line enters and leaves the
//   zone. κ and the linear J are taken there, and the zones of a pixel are laid over its surface
//   from back to front: I ← T I + ∫ κ e^{−κs} J ds (4).
// Resolution: `samples` sub-pixels a pixel, the next square number, on a regular grid. A line
// through
//   the middle of one stands for it: thin things may alias, where line_of_sight scatters its rays.
// Zones are sorted a pixel (by where they begin), so that there is no cycle of zones that cover
// each
//   other, as there may be where whole zones are sorted.
// Errors: mesh::InputError for an eye in a solid, and for cameras that are not perspective, or have
//   a lens: a projection onto a plane has one eye; and for bodies (renderers.h).
// Cost: elements × tiles of 128² sub-pixels, and the sub-pixels that each of them covers. Memory: a
//   tile's lists. Same bits at any thread count.
// Source: Rushmeier & Torrance (1987), section 5.
Image projected_zones(const radiosity::Solution& solution, const Camera& camera,
                      const RenderOptions& options = {},
                      const radiosity::ProgressCallback& progress = {});

}  // namespace tyndall::render
