// Surfaces that move from scene to scene, as bodies (mesh/body.h) in the mesh of what stands still.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "radiosity/enclosure.h"

namespace tyndall::radiosity {

// The surfaces whose polygons have moved, where that is all that two scenes differ in
// (compare_scenes.h), each polygon with as many corners as before; none where more has changed.
// Empty: nothing has moved.
std::optional<std::vector<std::size_t>> moved_surfaces(const Scene& before, const Scene& after);

// The scene without the polygons of these surfaces; their places among the surfaces stay.
Scene without_surfaces(const Scene& scene, std::span<const std::size_t> surfaces);

// Why these surfaces cannot be bodies in the still scene's mesh, as the end of a sentence that
// begins with "it"; empty: they can. They can where all of them are opaque, emit nothing, have no
// flux given, are made of convex polygons, lie within the hull of what stands still, and hold no
// camera, light or point of a medium; where no temperatures are found, and walks go on at no
// mirror.
std::string why_no_bodies(const Scene& scene, std::span<const std::size_t> surfaces,
                          const Enclosure& still);

// Purpose: the still scene's enclosure with the surfaces of a scene as bodies, one for each
//   connected set of their polygons, and that scene's emissions. A closed body whose fronts look
//   outward is a solid; of any other both sides see light.
// `still`: of without_surfaces(scene, surfaces).
// Cost: a copy of the enclosure.
Enclosure with_bodies(const Enclosure& still, const Scene& scene,
                      std::span<const std::size_t> surfaces);

// The bodies of both, those of the first first.
std::vector<mesh::Body> bodies_of(const Enclosure& before, const Enclosure& now);

}  // namespace tyndall::radiosity
