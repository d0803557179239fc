// Places where it is bright, at which a gather looks on purpose: openings, and haze about lamps.
//
// Purpose: behind a narrow slit nearly all light may come from a few thousandths of all directions,
//   and beside a lamp that stands in haze much of it from about the lamp; random rays find them by
//   luck. Rays are aimed there instead (bright_cones.h).
// Cost: some thousand walks a place.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/enclosure.h"
#include "radiosity/point_set.h"

namespace tyndall::radiosity {

class GatherScene;
struct OnPurpose;

struct BrightPlace {
    std::vector<std::array<Point, 3>> triangles;  // of an opening, in one plane; of a ball none
    Direction normal{0};                          // of that plane, unit
    Point centre{0};                              // of the ball, or of one about the opening
    double radius = 0.0;                          // [m]
    // Of an opening, what comes through it to its front and to its back, relative to what comes
    // from there; of a ball, twice, what chords of it bring, relative to what arrives around it:
    // means, of all bands together [-].
    std::array<double, 2> brightness{};

    // Or a ball.
    bool is_opening() const { return !triangles.empty(); }
};

// The bright places of a scene.
class BrightPlaces {
  public:
    // Those of an enclosure in the light of `scene` and of what is looked at besides: openings of
    // its walls first (mesh/wall_openings.h), then balls about what shines in a medium, small ones
    // before large ones. Keeps a reference to the enclosure's mesh.
    BrightPlaces(const Enclosure& enclosure, const GatherScene& scene, const OnPurpose& look,
                 std::uint64_t seed);

    std::span<const BrightPlace> all() const { return places_; }
    const mesh::BaseMesh& mesh() const { return mesh_; }
    // Directions are aimed by these, the first so many of them.
    const PointSet& points() const { return points_; }

  private:
    const mesh::BaseMesh& mesh_;
    std::vector<BrightPlace> places_;
    PointSet points_;
};

// What is less bright than this, relative to what is around, ordinary rays find well enough [-].
inline constexpr double bright = 2.0;

// Whether there may be any: a scene need not be made for it.
bool may_be_bright_somewhere(const Enclosure& enclosure);

}  // namespace tyndall::radiosity
