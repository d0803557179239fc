// Openings through which it is bright: where a gather looks on purpose.
//
// Purpose: behind a narrow slit nearly all light may come from a few thousandths of all directions,
//   which random ones find by luck. Rays are aimed at such openings instead, and the others carry
//   what comes from elsewhere.
// Equation: H = Σ_k w_k L(d_k) + (1 − W) / n' Σ_i L(d_i), W = Σ_k w_k                        (69)
//   d_k the aimed directions, w_k = Ω cosθ_k / (π m) on surfaces and Ω / (4π m) in zones, each for
//   its solid angle Ω; d_i those of n' ordinary ones that are not within any cone from the point
//   to an opening.
// Valid for: any scene: a set of directions is parted in two, whatever stands in them.
// Source: portals of Monte Carlo renderers; stratification, Hammersley & Handscomb (1964).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/enclosure.h"
#include "radiosity/point_set.h"

namespace tyndall::radiosity {

using mesh::Direction;
using mesh::Point;

class GatherScene;
struct OnPurpose;

// Interfaces of a scene (planar, each a group of facets that touch), as they are looked at from
// either side.
class BrightOpenings {
  public:
    struct Opening {
        std::vector<std::array<Point, 3>> triangles;
        Direction normal{0};  // unit
        Point centre{0};      // of a sphere about it
        double radius = 0.0;  // [m]
        // What comes through it to its front and to its back, relative to what comes from there:
        // means, of the band where that is most [-].
        std::array<double, 2> brightness{};
    };

    // Openings of the enclosure that are brighter than what is on one side of them, in the light of
    // `scene` and of what is looked at besides. Cost: a thousand walks a facet of an opening.
    BrightOpenings(const Enclosure& enclosure, const GatherScene& scene, const OnPurpose& look,
                   std::uint64_t seed);

    std::span<const Opening> all() const { return openings_; }
    // Directions are aimed by these, the first so many of them.
    const PointSet& points() const { return points_; }

  private:
    std::vector<Opening> openings_;
    PointSet points_;
};

// The cones from a point to the openings that are aimed at from there. To be used again for other
// points: it keeps its memory.
class OpeningCones {
  public:
    // A direction aimed at, and what it counts; 0 below the horizon.
    struct Aimed {
        Direction direction;
        double weight;
        bool first_half;  // of the aimed ones
    };

    // `normal`: zero in a zone; `rays`: how many ordinary ones are to be had. Aims where these
    // would leave a notable error, and at nothing that they find well enough.
    void look(const BrightOpenings& openings, Point x, Direction normal, std::size_t rays,
              std::uint64_t seed);
    void clear();

    bool empty() const { return cones_.empty(); }
    // Whether a direction (of any length) leads to an opening that is aimed at.
    bool cover(Direction d) const { return cover(d, cones_.size()); }
    std::span<const Aimed> aimed() const { return aimed_; }

  private:
    struct Cone {
        const BrightOpenings::Opening* opening;
        double noise;     // that ordinary rays would leave [-]
        double share;     // of all directions [-]
        std::size_t end;  // of its pieces
    };
    struct Piece {
        std::array<Direction, 3> corners, edges;  // unit vectors; normals of its edges' planes
        double solid_angle;                       // [sr]
    };

    bool cover(Direction d, std::size_t cones) const;
    void add_pieces(Direction a, Direction b, Direction c);
    void aim(std::size_t cone, const PointSet& points, std::size_t count, Direction normal,
             std::uint64_t seed);

    std::vector<Cone> cones_;
    std::vector<Piece> pieces_;  // of all cones, one after another
    std::vector<Aimed> aimed_;
};

}  // namespace tyndall::radiosity
