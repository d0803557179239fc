// Whether the light of a scene settles at all.
#pragma once

#include "radiosity/enclosure.h"

namespace tyndall::radiosity {

// Purpose: refuse what has no steady state, or one that nothing fixes: a closed group of regions
//   (joined by openings) in which nothing absorbs for good, that holds a source of light, or walls
//   and media of given flux and heat: these give back all that they take.
// Errors: mesh::InputError that names a surface around it.
// Cost: a few passes over facets and tetrahedra, for each band.
void refuse_unsteady(const Scene& scene, const Enclosure& enclosure);

}  // namespace tyndall::radiosity
