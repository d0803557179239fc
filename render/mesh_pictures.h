// Pictures of a mesh and of what its elements hold: their edges over a picture, their numbers in
// colours, as a camera sees them or on a plane through them.
#pragma once

#include <optional>
#include <string>

#include "mesh/types.h"
#include "radiosity/solution.h"
#include "render/camera.h"
#include "render/colour_map.h"
#include "render/tone_map.h"

namespace tyndall::render {

// Purpose: the edges of the patches that the camera sees, drawn over its picture, which is enlarged
//   by a whole number to some 640 pixels across. An edge is where two neighbouring pixels see two
//   leaves: hidden ones do not show, and where leaves are smaller than pixels all is edge.
// `picture`: of the camera's size. Cost: one walk a pixel.
DisplayImage mesh_overlay(const radiosity::Solution& solution, const Camera& camera,
                          const DisplayImage& picture);

struct Plane {
    mesh::Point point{0.0};
    mesh::Direction normal{0.0};  // of any length but 0
};

// Upright, through the middle of the media (of the hull where there is none), along the longer of
//   their two horizontal sides.
Plane default_plane(const radiosity::Enclosure& enclosure);

struct FieldOptions {
    std::string field = "radiance";   // one of field_names() (element_fields.h)
    std::optional<double> low, high;  // ends of the colours; none: by what is shown
    bool edges = true;                // of the elements
};

struct FieldPicture {
    DisplayImage image;
    ColourScale scale;
};

// Purpose: the zones that a plane cuts, coloured by a field (dark blue to yellow, light grey where
//   there is no medium, or no value), with their edges. 960 pixels along the longer side of the
//   media's extent. Up in the picture is z.
// Errors: mesh::InputError for a field that there is not, or ends of the colours that are none.
// Cost: one point location a pixel.
FieldPicture field_slice(const radiosity::Solution& solution, const Plane& plane,
                         const FieldOptions& options = {});

// Purpose: the patches that a camera sees, coloured by a field, as if there were no medium. Light
//   grey where there is none. Errors: as above. Cost: one walk a pixel.
FieldPicture field_picture(const radiosity::Solution& solution, const Camera& camera,
                           const FieldOptions& options = {});

}  // namespace tyndall::render
