// Cameras: from a point of the picture, and of the lens, to a ray.
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <string>

#include "mesh/types.h"
#include "mesh/walk.h"
#include "radiosity/view.h"

namespace tyndall::render {

// A thin lens: what is at the focus distance along the view is sharp.
struct Lens {
    double diameter = 0.0;  // [m]
    double focus = 0.0;     // distance of the sharp plane from the eye [m]

    bool operator==(const Lens&) const = default;
};

// A camera with square pixels. Of the angles (perspective) or of the extents (orthographic) exactly
// one is given; a panorama has neither, is twice as wide as high, and its up is the zenith.
struct Camera {
    std::string name = "main";
    radiosity::PictureProjection projection = radiosity::PictureProjection::perspective;
    mesh::Point eye{0};     // [m]
    mesh::Point target{0};  // in the middle of the picture [m]
    mesh::Direction up{0, 0, 1};
    std::optional<double> fov_x, fov_y;        // whole angle across the picture [rad]
    std::optional<double> extent_x, extent_y;  // whole length across the picture [m]
    std::optional<Lens> lens;                  // of a perspective picture; none: a pinhole
    std::size_t width = 640, height = 480;     // [pixel]
    // Where the picture is a part of a larger one: what is to the left of it and above, and the
    // size of the whole; 0: the picture is the whole [pixel].
    std::size_t left = 0, top = 0, whole_width = 0, whole_height = 0;

    bool operator==(const Camera&) const = default;

    // Purpose: the ray through (x, y), as CameraRays gives it; for one ray, as it builds the frame.
    // Errors: those of view().
    mesh::Ray ray(double x, double y) const;

    // Purpose: the view of the whole picture, which the refinement works with.
    // Errors: mesh::InputError if a number is not finite, eye and target coincide, up is
    //   parallel to the view, not exactly one angle (extent) is given or it is not in (0, 180°)
    //   (above 0), a lens is not of a perspective picture or has no size or focus, a panorama is
    //   not twice as wide as high, or a size is zero.
    radiosity::View view() const;

    // Purpose: the camera of `width` × `height` pixels of this one's picture, `left` pixels from
    //   its left edge and `top` below its upper one: its pixels are those of the whole picture.
    // Errors: mesh::InputError if there are no such pixels.
    Camera cropped(std::size_t left, std::size_t top, std::size_t width, std::size_t height) const;
};

// The rays of a camera's whole picture: its frame is built once.
class CameraRays {
  public:
    // Errors: those of Camera::view().
    explicit CameraRays(const Camera& camera);

    // Purpose: the ray through (x, y) in pixels from the top left corner, x to the right and y
    //   down; the centre of the first pixel is (0.5, 0.5). Points outside the picture are good,
    //   too. `lens`: place on the lens, from [0, 1)²; its middle gives a pinhole's ray.
    // Equation: View::ray(2x/width − 1, 1 − 2y/height), right = forward × up (right-handed: what is
    //   to the viewer's right is to the right in the picture). With a lens the ray goes from a
    //   place on the disc about the eye, across the view, to where the pinhole's ray meets the
    //   plane that is sharp.
    // Source of the map to the disc: Shirley & Chiu (1997).
    mesh::Ray operator()(double x, double y, glm::dvec2 lens = glm::dvec2(0.5)) const;

  private:
    radiosity::View frame_;
    std::optional<Lens> lens_;
    double left_, top_, width_, height_;  // of the whole [pixel]
};

}  // namespace tyndall::render
