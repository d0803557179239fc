// The exchange area of one pair of elements by sampled points, shadow rays and subdivision.
#pragma once

#include "radiosity/cubature.h"
#include "radiosity/element_pieces.h"

namespace tyndall::radiosity {

// Purpose: ∬ τ k_a k_b / (π s²) over two elements, k the cosine at a patch and κ in a zone
//   (8)–(10).
//
// Two pieces (triangles, tetrahedra) far from each other: a product of two rules, with a shadow ray
//   between each pair of points.
// Two that are near, touch or are the same, without the singularity: from points of the first over
//   the directions to the second, along each ray through it in closed form,
//     ∫_a k_a (1/π) ∫ τ (1 − e^{−κ_b l}) dω dx,
//   l the chord in a tetrahedron b; the bracket is 1 at a patch. The directions are those of the
//   cones from one face of b to another, and scaled to what the cone really subtends (solid angle;
//   from a patch Lambert's form).
// Two that are near, with nothing but one medium between: over their faces f, g, outward normals n,
//   the integral along a line through both in closed form, u = κ s its optical depth,
//     V_kV_m = −Σ_f Σ_g ∬ (u − 1 + e^{−u}) (n_f·ω) (n_g·ω) / (π s²) dA_f dA_g,
//     S_jV_k = Σ_g ∬ (1 − e^{−u}) cosθ_j (n_g·ω) / (π s²) dA_j dA_g:
//   the divergence theorem, applied to both zones; the terms u − 1 that it leaves free are so
//   chosen that nothing is singular where the zones touch, or are one.
//   A cluster of tetrahedra with itself, with a patch or with another cluster near by is taken so
//   as a whole, over its own surface, if all members' centres see each other.
// Subdivision: of all pairs of pieces the one with the largest estimated error has a piece
//   bisected, until the estimates add up to `tolerance` of the whole, or the rays run out.
//
// Error: estimated from rules of degree 1, 2 and 5; it falls slowly where the edges of shadows
//   decide. What falls between all points of a rule is not seen.
// Cost: of each pair of members some 10 to 400 rays, and then `most_rays` at most (points of faces
//   count as rays).
// Source: Wallace, Elmquist & Haines (1989), who subdivide the source alone, into parts that they
//   take for discs; van Oosterom & Strackee (1983) and Lambert (1760) for what polygons subtend.
class PairIntegral {
  public:
    static constexpr std::size_t most_rays = 1u << 20;

    PairIntegral(const Enclosure& enclosure, std::size_t band, double tolerance);

    // [m^2]; `same`: of an element with itself.
    double operator()(std::span<const Piece> a, std::span<const Piece> b, bool same) const;

  private:
    // Of the elements; or of two faces of zones, of a patch and the face of a zone.
    enum class Kernel { points, faces, patch_face };
    struct Pair {
        Piece a, b;
        double factor;  // how often it counts
        Kernel kernel = Kernel::points;
        Degree degree = Degree::two;
        double value = 0.0, error = 0.0, first_difference = 0.0;  // [m^2]
    };
    struct Estimate;
    struct Work;
    class Look;

    static bool far(const Pair& pair);
    static double doubt(const Pair& pair);
    void add_members(std::span<const Piece> a, std::span<const Piece> b, bool same,
                     Work& work) const;
    void add_faces(std::span<const Piece> from, std::span<const Piece> to, double factor,
                   Work& work) const;
    // Whether all lines between the two lie in one medium, as far as rays tell.
    bool uniform(const Pair& pair) const;
    bool uniform(std::span<const Piece> a, std::span<const Piece> b, bool same) const;
    void add(Pair pair, Work& work) const;
    void raise(Pair& pair, Work& work) const;
    Estimate evaluate(const Pair& pair, Degree degree) const;
    Estimate by_points(const Pair& pair, Degree degree) const;
    Estimate by_directions(const Pair& pair, Degree degree) const;
    // Between points of two pieces [-]; infinite if they do not see each other.
    double optical_depth(const Piece& a, Point x, const Piece& b, Point y) const;

    const Enclosure& enclosure_;
    std::vector<double> extinction_;  // of base tets [1/m]
    double tolerance_;
};

}  // namespace tyndall::radiosity
