// The spectra of a scene, each with as many values as the scene has bands.
#pragma once

#include "radiosity/scene.h"

namespace tyndall::radiosity {

// Purpose: the scene with a value a band wherever a spectrum was given: one value holds for all
//   bands. A flux or heat of one value in several bands that have wavelengths (Scene::spectral) is
//   that of all bands together, and stays one.
// Errors: mesh::InputError with the name of the material, medium or light (and Scene's `where`)
//   whose spectrum has another number of values, or one that is not finite; whose reflectance,
//   extinction or albedo is not given.
// Cost: a copy of the scene without its polygons' coordinates being looked at.
Scene with_all_bands(Scene scene);

}  // namespace tyndall::radiosity
