// Pictures of a mesh: its leaves' edges over a picture, and a plane through it.
#pragma once

#include "mesh/types.h"
#include "radiosity/solution.h"
#include "render/camera.h"
#include "render/tone_map.h"

namespace tyndall::cli {

// Purpose: the edges of the patches that the camera sees, drawn over its picture, which is enlarged
//   by a whole number to some 640 pixels across. An edge is where two neighbouring pixels see two
//   leaves: hidden ones do not show, and where leaves are smaller than pixels all is edge.
// `picture`: of the camera's size. Cost: one walk a pixel.
render::DisplayImage mesh_overlay(const radiosity::Solution& solution, const render::Camera& camera,
                                  const render::DisplayImage& picture);

struct Plane {
    mesh::Point point{0.0};
    mesh::Direction normal{0.0};  // of any length but 0
};

// Upright, through the middle of the media (of the hull where there is none), along the longer of
//   their two horizontal sides.
Plane default_plane(const radiosity::Enclosure& enclosure);

// Purpose: the zones that a plane cuts, coloured by the logarithm of J as their linear functions
//   hold it (dark blue to yellow: the 0.5th to the 99.5th percentile of the plane, at most three
//   decades), with their edges; light grey where there is no medium. 960 pixels along the longer
//   side of the media's extent. Up in the picture is z.
// Cost: one point location a pixel.
render::DisplayImage mesh_slice(const radiosity::Solution& solution, const Plane& plane);

}  // namespace tyndall::cli
