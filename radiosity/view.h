// The part of space that a picture shows: rays through it, and what of space is in it.
#pragma once

#include "mesh/types.h"
#include "mesh/walk.h"

namespace tyndall::radiosity {

enum class PictureProjection {
    perspective,   // all rays from one point, straight lines stay straight
    orthographic,  // all rays parallel, from a plane through the eye
    panorama       // all rays from one point, all around: longitude across, latitude upright
};

struct View {
    PictureProjection projection = PictureProjection::perspective;
    mesh::Point eye{0};                           // [m]
    mesh::Direction forward{0}, right{0}, up{0};  // orthonormal
    // From the middle of the picture to its right and upper edge: tangents of half the angles
    // (perspective), lengths [m] (orthographic), π and π/2 [rad] (panorama).
    double half_x = 1.0, half_y = 1.0;

    // Purpose: the ray through the point (s, t) of the picture, from −1 at the left and lower edge
    //   to 1.
    // Equation: perspective: forward + s half_x right + t half_y up, normalized. Orthographic: the
    //   origin is off the eye by s half_x right + t half_y up. Panorama: with φ = s π, θ = t π/2,
    //   cos θ (cos φ forward + sin φ right) + sin θ up.
    mesh::Ray ray(double s, double t) const;

    // What the whole picture covers: a solid angle [sr] or, if orthographic, an area [m²].
    double extent() const;

    // Whether a sphere may be in the picture.
    bool sees(mesh::Point centre, double radius) const;

    // Purpose: what of `extent()` a small surface covers. `projected`: its area as the rays there
    //   see it [m²]; `size`: its length, nearer than which it covers no more [m].
    double covered(mesh::Point centre, double projected, double size) const;

    // Of the ray that sees x (of no use at the eye itself).
    mesh::Direction direction_to(mesh::Point x) const;
    // Along that ray [m].
    double distance_to(mesh::Point x) const;
};

}  // namespace tyndall::radiosity
