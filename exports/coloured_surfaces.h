// A solution's surfaces as triangles in the colours of their light: PLY and OBJ files.
#pragma once

#include "exports/exported_files.h"
#include "radiosity/solution.h"
#include "render/options.h"

namespace tyndall::exports {

// Purpose: a PLY file (ply_file.h) of all patches, a set of points each, so that patches that
//   touch keep their own light: the radiance that leaves their sides as sRGB colours, tone mapped
//   as PNG files are, and its numbers beside them: `radiosity` [W/m^2] with one band, else
//   `radiosity_0` and so on.
// Exposure: `white`, or the logarithmic average of the patches by area where there is none.
// Errors: mesh::InputError for a white that is not positive. Cost: O(patches).
ExportedFiles coloured_ply(const radiosity::Solution& solution,
                           const render::ToneMapOptions& tone = {});

// Purpose: the same as OBJ, with a group and a material a side, colours behind the points' places
//   (as most programs read them), and a MTL file STEM.mtl: Kd the reflectance, Ke the emission.
ExportedFiles coloured_obj(const radiosity::Solution& solution, const std::string& stem,
                           const render::ToneMapOptions& tone = {});

}  // namespace tyndall::exports
