#include "render/eye.h"

#include <fmt/format.h>

#include "mesh/input_error.h"

namespace tyndall::render {

mesh::TetId tet_of_eye(const radiosity::Enclosure& enclosure, const Camera& camera) {
    const mesh::TetId eye = mesh::locate(enclosure.mesh, camera.eye);
    if (eye.valid() && enclosure.solid(eye))
        throw mesh::InputError(fmt::format(
            "camera \"{}\" at [{}, {}, {}] stands inside a solid. Move its eye into the open.",
            camera.name, camera.eye.x, camera.eye.y, camera.eye.z));
    return eye;
}

}  // namespace tyndall::render
