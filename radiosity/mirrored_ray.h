// How a walk goes on at a perfect mirror.
#pragma once

#include "mesh/walk.h"
#include "radiosity/enclosure.h"

namespace tyndall::radiosity {

// What a ray may still carry, of what it began with, when it is not worth following further: what
// is left counts as if it were spread like all the rest [-].
inline constexpr double little_mirrored = 1e-4;
// Mirrors that a ray is followed through: between two that take next to nothing it never ends.
inline constexpr std::size_t most_mirrors = 1000;

struct MirroredRay {
    mesh::Ray ray;
    mesh::WalkStart start;
};

// Purpose: the ray that begins where a walk along `ray` has struck a facet, on the same side of it,
//   turned about its normal n: d − 2 (d·n) n. Its length is what is left of the ray's.
// Source: the extended form factors of Rushmeier & Torrance (1990) and the image rooms of Wallace,
//   Cohen & Greenberg (1987), ray by ray.
MirroredRay mirrored_ray(const mesh::BaseMesh& mesh, const mesh::Ray& ray,
                         const mesh::WalkEnd& struck);

// The side that a walk has struck, if walks go on at it; null otherwise.
inline const SurfaceSide* mirror_struck(const Enclosure& enclosure, const mesh::WalkEnd& end) {
    if (end.arrival != mesh::Arrival::struck) return nullptr;
    const auto side = enclosure.facet_sides[end.facet.value][end.side == Side::back];
    return side == none || enclosure.sides[side].mirror.empty() ? nullptr : &enclosure.sides[side];
}

}  // namespace tyndall::radiosity
