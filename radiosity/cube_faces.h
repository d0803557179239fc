// Planes divided into pixels, on which what a point sees is projected: hemi-cube, full cube, single
// plane.
#pragma once

#include <vector>

#include "mesh/types.h"

namespace tyndall::radiosity {

// A rectangle of nu × nv pixels in a plane at distance 1 from the eye. Directions are those of the
// cube: z is the normal of a patch. A direction through (u, v) has the components ±1, u, v along
// the axes `across`, `along_u`, `along_v`.
struct CubeFace {
    int across = 2, along_u = 0, along_v = 1;
    double sign = 1.0;  // the face is at +1 or at −1 along `across`
    double u_min = -1.0, u_max = 1.0, v_min = -1.0, v_max = 1.0;
    std::size_t nu = 1, nv = 1;
    std::vector<double> weights{};  // delta form factors, [v · nu + u] [-]

    double u_step() const { return (u_max - u_min) / static_cast<double>(nu); }
    double v_step() const { return (v_max - v_min) / static_cast<double>(nv); }
    double u(std::size_t i) const { return u_min + (static_cast<double>(i) + 0.5) * u_step(); }
    double v(std::size_t j) const { return v_min + (static_cast<double>(j) + 0.5) * v_step(); }
    // Through the middle of a pixel; not of unit length.
    mesh::Direction direction(std::size_t i, std::size_t j) const {
        mesh::Direction d;
        d[across] = sign;
        d[along_u] = u(i);
        d[along_v] = v(j);
        return d;
    }
};

// Half of the edge of the single plane, over its distance from the patch. What it leaves out is
// 1 − (4/π) s atan s, s² = h²/(1 + h²): 1.6 % of every row. A larger plane has larger pixels.
inline constexpr double single_plane_half_width = 7.0;

// The delta form factor of a pixel is the integral over it, in closed form, so that those of a cube
// add up to 1 whatever its pixels:
//   hemi-cube, single plane:  ∫ cosθ dω / π,   dω = du dv / r³, r² = 1 + u² + v²
//     above    ∬ du dv / (π r⁴):    ½ (u/a atan(v/a) + v/b atan(u/b)), a² = 1 + u², b² = 1 + v²
//     beside   ∬ v du dv / (π r⁴):  −atan(u/b) / 2b
//   full cube:                ∫ dω / 4π: atan(u v / r)
// each the mixed difference over the pixel's corners, over π or 4π. `resolution`: pixels along an
// edge of a cube, half as many (rounded up) on the height of a hemi-cube's sides.
// Cost: O(resolution²).
// Source: Cohen & Greenberg (1985) with the pixel's middle; Rushmeier & Torrance (1987) for zones.
std::vector<CubeFace> hemicube_faces(std::size_t resolution);
std::vector<CubeFace> full_cube_faces(std::size_t resolution);
std::vector<CubeFace> single_plane_faces(std::size_t resolution);

}  // namespace tyndall::radiosity
