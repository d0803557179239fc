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
    struct Aimed {
        Direction direction;
        double weight;    // what it counts [-]
        bool first_half;  // of those in its cone
        bool through_opening;
    };

    // `rays`: how many ordinary ones are to be had. Aims where these would leave a notable error,
    // and at nothing that they find well enough or that is hidden.
    void look(const BrightPlaces& places, const GatherPoint& point, std::size_t rays,
              std::uint64_t seed);
    void clear();

    bool empty() const { return cones_.empty(); }
    std::span<const Aimed> aimed() const { return aimed_; }
    // Whether a direction (of any length) lies in a cone; in one to an opening.
    bool cover(Direction d) const { return cover(d, cones_.size()); }
    bool cover_by_openings(Direction d) const { return cover(d, openings_); }

  private:
    struct Cone {
        const BrightPlace* place;
        double brightness = 0.0, noise = 0.0;  // that of ordinary rays [-]
        double share = 0.0;                    // of all directions [-]
        double solid_angle = 0.0;              // [sr]
        Direction axis{0};                     // unit, of a ball
        double cosine = 0.0;                   // of the angle about it
        std::size_t end = 0;                   // of an opening's pieces
    };
    struct Piece {
        std::array<Direction, 3> corners, edges;  // unit vectors; normals of its edges' planes
        double solid_angle;                       // [sr]
    };

    static Cone to_opening(const BrightPlace& opening, const GatherPoint& point);
    static Cone to_ball(const BrightPlace& ball, const GatherPoint& point);
    static bool shows(const mesh::BaseMesh& mesh, const Cone& cone, const GatherPoint& point);
    void keep_most_noisy();
    void add_pieces(const BrightPlace& opening, Point x);
    bool cover(Direction d, std::size_t cones) const;
    void aim(std::size_t cone, const PointSet& points, std::size_t count, const GatherPoint& point,
             std::uint64_t seed);
    std::pair<Direction, double> in_opening(std::size_t cone, double u, double v) const;
    std::pair<Direction, double> in_ball(const Cone& cone, double u, double v) const;

    std::vector<Cone> cones_;
    std::size_t openings_ = 0;   // of the cones, they come first
    std::vector<Piece> pieces_;  // of all openings, one after another
    std::vector<Aimed> aimed_;
};

}  // namespace tyndall::radiosity
