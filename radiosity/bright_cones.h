// The directions from a point to bright places, and the rays that are aimed there.
//
// Equation: H = Σ_k w_k L(d_k) + (1 − W) / n' Σ_i L(d_i), W = Σ_k w_k                        (69)
//   d_k the aimed directions, w_k = Ω cosθ_k / (π m) on surfaces and Ω / (4π m) in zones, m of them
//   in a cone of solid angle Ω; d_i those of n' ordinary ones that are not within any cone. Of
//   cones that overlap the first has what they share.
// Valid for: any scene: a set of directions is parted, whatever stands in them.
// Source: stratification and importance sampling, Hammersley & Handscomb (1964); portals of Monte
//   Carlo renderers; light about a lamp in haze, Kulla & Fajardo (2012).
#pragma once

#include "radiosity/bright_places.h"
#include "radiosity/gather_point.h"

namespace tyndall::radiosity {

// To be used for one point after another: it keeps its memory.
class BrightCones {
  public:
    // A ray that is aimed at a bright place.
    struct Aimed {
        Direction direction;
        double weight;    // what it counts [-]
        bool first_half;  // of those in its cone
        // Whence on it brings what lit patches reflect: beyond its opening; else never [m].
        double lit_beyond;
    };

    // `rays`: how many ordinary ones are to be had. Aims where these would leave a notable error,
    // and at nothing that they find well enough or that seems hidden.
    void look(const BrightPlaces& places, const GatherPoint& point, std::size_t rays,
              std::uint64_t seed);
    void clear();

    bool empty() const { return cones_.empty(); }
    std::span<const Aimed> aimed() const { return aimed_; }
    // Whether a direction (of any length) lies in a cone.
    bool cover(Direction d) const { return first_cone(d, cones_.size()) < cones_.size(); }
    // Whether what is sent from the end of a path to the point is left to aimed rays, where lit
    // patches are looked at apart: it comes through an opening that they are aimed at.
    bool bring_lit(Direction path) const;

  private:
    struct Cone {
        const BrightPlace* place;
        double brightness = 0.0, noise = 0.0;  // that of ordinary rays [-]
        double share = 0.0;                    // of all directions [-]
        double solid_angle = 0.0;              // [sr]
        Direction axis{0};                     // unit, of a ball
        double cosine = 0.0;                   // of the angle about it
        double height = 0.0;                   // of the point above an opening's front [m]
        std::size_t end = 0;                   // of an opening's pieces
        std::size_t aimed = 0;                 // twice the ordinary rays in it
    };
    struct Piece {
        std::array<Direction, 3> corners, edges;  // unit vectors; normals of its edges' planes
        double solid_angle;                       // [sr]
    };

    static Cone to_opening(const BrightPlace& opening, const GatherPoint& point);
    static Cone to_ball(const BrightPlace& ball, const GatherPoint& point);
    void choose(const mesh::BaseMesh& mesh, const GatherPoint& point);
    void add_pieces(const BrightPlace& opening, Point x);
    // The first of so many cones that a direction lies in; their number if none.
    std::size_t first_cone(Direction d, std::size_t cones) const;
    void aim(std::size_t cone, const PointSet& points, std::size_t count, const GatherPoint& point,
             std::uint64_t seed);
    std::pair<Direction, double> in_opening(std::size_t cone, double u, double v) const;
    std::pair<Direction, double> in_ball(const Cone& cone, double u, double v) const;

    std::vector<Cone> cones_;
    std::vector<Piece> pieces_;  // of all openings, one after another
    std::vector<Aimed> aimed_;
};

}  // namespace tyndall::radiosity
