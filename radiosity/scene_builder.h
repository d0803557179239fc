// Scenes from C++ with few words: a shape and what it is made of, in one call.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mesh/shapes.h"
#include "radiosity/scene.h"

namespace tyndall::radiosity {

// Purpose: adds a shape, or the faces of a mesh file. A face becomes the surface "name.face", or
//   "name" where it has no name of its own. Openings become interfaces: light passes them.
// `material`: of the front, and of the back unless `back` says otherwise. Materials without a name
//   get that of the surface, and "… back".
// Errors: mesh::InputError where a surface of that name is there already.
void add_surface(Scene& scene, const std::string& name, const std::vector<mesh::Face>& shape,
                 Material material, std::optional<Material> back = {});

}  // namespace tyndall::radiosity
