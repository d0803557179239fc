// What an enclosure's sides, media and lights send out: bound last, and anew when nothing else has
// changed.
#pragma once

#include "radiosity/enclosure.h"

namespace tyndall::radiosity {

// The material of a surface's side, and whether it emits there.
struct SideMaterial {
    const Material* material = nullptr;
    bool emits = false;
};
SideMaterial material_of_side(const Scene& scene, std::size_t surface, Side side);

// A side of a surface as a SurfaceSide: its name and optics, but for its emission and its area.
SurfaceSide side_of_surface(const Scene& scene, const Enclosure& enclosure, std::size_t surface,
                            Side side);

// Purpose: the emissions of all sides and media, lights and environment are those of the scene. The
//   scene may differ from the one that the enclosure was made of in these alone
//   (compare_scenes.h). A given flux is an emission where it is that of each band (not settles()).
//   A power is that of a whole surface: all its faces share it by area.
// Errors: mesh::InputError: a power on a surface without area that faces light. Sources in a closed
//   region without absorption are refused by make_enclosure alone.
// Cost: O(sides).
void bind_emissions(const Scene& scene, Enclosure& enclosure);

}  // namespace tyndall::radiosity
