// Where a camera stands in the mesh.
#pragma once

#include "radiosity/enclosure.h"
#include "render/camera.h"

namespace tyndall::render {

// Purpose: the tet that holds the camera's eye; none: outside the hull.
// Errors: mesh::InputError for an eye in a solid.
mesh::TetId tet_of_eye(const radiosity::Enclosure& enclosure, const Camera& camera);

}  // namespace tyndall::render
