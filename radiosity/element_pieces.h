// Elements as simplices: the triangles of a patch, the tetrahedra of a zone, the open faces of the
// hull for outside. What pairs of elements are integrated over.
#pragma once

#include "radiosity/exchange.h"

namespace tyndall::radiosity {

// A triangle or a tetrahedron, in one base tet.
struct Piece {
    std::array<Point, 4> corners{};  // a triangle has three
    bool solid = false;              // a tetrahedron
    bool face = false;               // of a tetrahedron, its normal outward; no patch
    Direction normal{0};             // unit, of a triangle, into the tet
    double extinction = 0.0;         // of the tet that it is in, or looks into [1/m]
    double measure = 0.0;            // area [m^2] or volume [m^3]
    double radius = 0.0;             // of the ball around the centre that holds it [m]
    Point centre{0};                 // its centroid
    mesh::WalkStart start;           // of rays that leave it

    std::size_t size() const { return solid ? 4 : 3; }
    Point at(const std::array<double, 4>& weights) const {
        Point x = weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
        if (solid) x += weights[3] * corners[3];
        return x;
    }
};

// Fills measure, centre, radius from the corners.
void measure(Piece& piece);

// The two halves at the middle of the longest edge; which of equally long edges depends on the
// corners' order only.
std::array<Piece, 2> bisect(const Piece& piece);

// The squared length of the longest edge [m^2].
double longest_edge_squared(const Piece& piece);

// Whether some of b, or all of it, lies behind the plane of a triangle a; no of a tetrahedron a.
bool straddles(const Piece& a, const Piece& b);
bool behind(const Piece& a, const Piece& b);

// A face of a tetrahedron.
struct PieceFace {
    std::array<Point, 3> corners;
    Direction normal;  // unit, outward
    double area;       // [m^2]
};
std::array<PieceFace, 4> outward_faces(const Piece& tetrahedron);

// A triangle itself, or the faces of a tetrahedron, with outward normals, as pieces.
std::vector<Piece> faces_of(const Piece& piece);
// The same of pieces together: without the faces that two tetrahedra share.
std::vector<Piece> boundary_of(std::span<const Piece> pieces);

// Around the centroid of pieces.
struct Ball {
    Point centre{0};
    double radius = 0.0;
};
Ball ball_of(std::span<const Piece> pieces);

// The pieces of all elements, and of outside.
class ElementPieces {
  public:
    // Cost: O(members).
    ElementPieces(const Discretization& discretization, std::size_t band);

    std::span<const Piece> operator[](std::size_t element) const {
        return std::span(pieces_).subspan(starts_[element],
                                          starts_[element + 1] - starts_[element]);
    }
    // How far apart two elements are at the least: the gap between balls around their pieces [m].
    double gap(std::size_t a, std::size_t b) const;

  private:
    void add_patch(const Discretization& discretization, PatchId patch);
    void add_zone(const Discretization& discretization, ZoneId zone);
    void add_outside(const Enclosure& enclosure);
    void finish_element();

    std::size_t band_;
    std::vector<Piece> pieces_;
    std::vector<std::size_t> starts_{0};
    std::vector<Ball> balls_;
};

}  // namespace tyndall::radiosity
