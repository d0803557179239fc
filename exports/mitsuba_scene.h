// The room as a scene of Mitsuba 3 (W. Jakob et al. 2022), a path tracer that anyone can check a
// picture against.
#pragma once

#include <span>

#include "exports/exported_files.h"
#include "exports/path_tracer_options.h"
#include "radiosity/enclosure.h"
#include "render/camera.h"

namespace tyndall::exports {

// Purpose: a scene (XML, format 3) whose pixels, rendered by a variant of rgb or mono, are our
//   radiances [W/m^2/sr]: surfaces as PLY files with materials on both sides and emitters in front,
//   media with their own coefficients and phase functions between null boundaries, lights, the
//   environment, and every camera, the first one given first. Integrator: volpath, without a limit
//   of bounces; volpathmis where extinctions of bands differ.
// A sun of a finite angle becomes a disc ten thousand rooms away.
// Noted: a spot's soft edge, which falls linearly there; what microfacets reflect more than once
//   (with_lost_light).
// Errors: those of path_room; mesh::InputError for a panorama, and for media that emit, which
//   Mitsuba has no word for.
// Cost: O(facets + tets).
ExportedFiles mitsuba_scene(const radiosity::Enclosure& enclosure,
                            std::span<const render::Camera> cameras,
                            const PathTracerOptions& options = {});

}  // namespace tyndall::exports
