// The room as a scene of pbrt-v4 (M. Pharr, W. Jakob & G. Humphreys 2023), a path tracer.
#pragma once

#include <span>

#include "exports/exported_files.h"
#include "exports/path_tracer_options.h"
#include "radiosity/enclosure.h"
#include "render/camera.h"

namespace tyndall::exports {

// Purpose: a scene whose pixels are our radiances [W/m^2/sr], as mitsuba_scene, with pbrt's
//   conventions: one camera; one material for both sides of a sheet, so that walls whose sides
//   differ are two sheets (path_room.h); cameras look along left-handed axes.
// Lights: pbrt scales every spectrum of a light to a luminance of its colour, so that "rgb L" is
//   what a pixel shows.
// Noted: bands are colours of spectra there, and multiply as such; a mirror of pbrt reflects more
//   at grazing angles; spots' edges fall otherwise; cameras that are left out.
// Errors: those of path_room; mesh::InputError for a panorama, Rayleigh's phase function, and a
//   medium that emits without absorbing.
// Source: pbrt-v4, "Input file format".
// Cost: O(facets + tets).
ExportedFiles pbrt_scene(const radiosity::Enclosure& enclosure,
                         std::span<const render::Camera> cameras,
                         const PathTracerOptions& options = {});

}  // namespace tyndall::exports
