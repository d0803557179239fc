// Where elements are beside the bodies (mesh/body.h) that stand in them: what a body covers holds
// no light, and no light is asked for there.
#pragma once

#include "mesh/body.h"
#include "radiosity/elements.h"

namespace tyndall::radiosity {

struct OpenPlace {
    Point x{0};  // [m]
    TetId tet;
};

// A place in a medium, moved onto the nearest point of the body that covers it, if one does and
// light can be there: what is linear between such places goes on smoothly into the body. `tet`:
// that of x. Cost: a sphere a body.
OpenPlace open_place(const Enclosure& enclosure, Point x, TetId tet);

// Whether a body covers a point of a surface with the given normal (0: a point of a medium).
bool covered(const Enclosure& enclosure, Point x, Direction normal = Direction(0.0));

// The share of an element that no body covers, by as many points as asked for; 1 without any where
// no body is near. By 0 points: 0 where one covers all corners, else 1 [-].
double open_share(const Enclosure& enclosure, const Forest& forest, ZoneId zone,
                  std::size_t points);
double open_share(const Enclosure& enclosure, const Forest& forest, PatchId patch,
                  std::size_t points);

// Points for the share of an element of the coarse solution, and of a leaf, whose errors have
// either sign.
inline constexpr std::size_t element_share_points = 256, leaf_share_points = 16;

// What an element that is covered all over counts, of its area or volume: nothing that could be
// seen, and enough for it to have a row.
inline constexpr double least_open = 1e-9;

}  // namespace tyndall::radiosity
