// Cameras: from a point of the picture to a ray.
#pragma once

#include <optional>
#include <string>

#include "mesh/types.h"
#include "mesh/walk.h"

namespace tyndall::render {

// A pinhole camera. Exactly one of the two angles is given.
struct Camera {
    std::string name = "main";
    mesh::Point eye{0};     // [m]
    mesh::Point target{0};  // [m]
    mesh::Direction up{0, 0, 1};
    std::optional<double> fov_x, fov_y;     // whole angle across the picture [rad]
    std::size_t width = 640, height = 480;  // [pixel]

    // The ray through (x, y) in pixels from the top left corner; throws mesh::InputError if eye and
    // target coincide or up is parallel to the view.
    mesh::Ray ray(double x, double y) const;
};

}  // namespace tyndall::render
