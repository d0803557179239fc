// Cameras: from a point of the picture to a ray.
#pragma once

#include <optional>
#include <string>

#include "mesh/types.h"
#include "mesh/walk.h"
#include "radiosity/options.h"

namespace tyndall::render {

// A pinhole camera with square pixels. Exactly one of the two angles is given.
struct Camera {
    std::string name = "main";
    mesh::Point eye{0};     // [m]
    mesh::Point target{0};  // in the middle of the picture [m]
    mesh::Direction up{0, 0, 1};
    std::optional<double> fov_x, fov_y;     // whole angle across the picture [rad]
    std::size_t width = 640, height = 480;  // [pixel]

    // Purpose: the ray through (x, y), as CameraRays gives it; for one ray, as it builds the frame.
    // Errors: those of view().
    mesh::Ray ray(double x, double y) const;

    // Purpose: the orthonormal frame and the half angles' tangents, which the refinement works
    //   with.
    // Errors: mesh::InputError if a number is not finite, eye and target coincide, up is
    //   parallel to the view, not exactly one angle is given or it is not in (0, 180°), or a size
    //   is zero.
    radiosity::View view() const;
};

// The rays of a camera's whole picture: its frame is built once.
class CameraRays {
  public:
    // Errors: those of Camera::view().
    explicit CameraRays(const Camera& camera);

    // Purpose: the ray through (x, y) in pixels from the top left corner, x to the right and y
    //   down; the centre of the first pixel is (0.5, 0.5). Points outside the picture are good,
    //   too.
    // Equation: direction = forward + (2x/width − 1) tan(fov_x/2) right
    //                               + (1 − 2y/height) tan(fov_y/2) up,
    //   right = forward × up (right-handed: what is to the viewer's right is to the right in the
    //   picture).
    mesh::Ray operator()(double x, double y) const;

  private:
    radiosity::View frame_;
    double width_, height_;  // [pixel]
};

}  // namespace tyndall::render
