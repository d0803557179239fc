// The working state of `conform`: loops of numbered points in numbered planes.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <optional>
#include <unordered_map>
#include <vector>

#include "mesh/conform_exact.h"
#include "mesh/point_weld.h"
#include "mesh/types.h"

namespace tyndall::mesh::conforming {

// An input polygon that a piece lies on, and whether it looks the other way.
struct Owner {
    Index polygon;
    bool reversed;
};

// A planar loop of points: an input polygon, or in a second round one facet of the first.
struct Piece {
    std::vector<Index> loop;
    std::vector<Owner> owners;
    Index plane = 0;
};

struct Plane {
    Direction normal;
    double offset = 0.0;  // normal · x [m]

    double above(Point x) const;        // [m]
    glm::dvec2 flatten(Point x) const;  // drops the normal's largest component; keeps orientation
    Point lift(glm::dvec2 x) const;     // the inverse on the plane
};

struct Soup {
    double tolerance;  // [m]
    PointWeld weld;
    std::vector<Piece> pieces;
    std::vector<Plane> planes;

    const Point& at(Index i) const { return weld.points()[i]; }
    const Plane& plane_of(const Piece& piece) const { return planes[piece.plane]; }
};

using Pairs = std::vector<std::pair<Index, Index>>;

// The area vector [m^2] of a loop (Newell): normal times area.
glm::dvec3 area_vector(const Soup& soup, const std::vector<Index>& loop);

// The plane through a loop, from the two corners that span it best; none if the loop is thinner
// than the tolerance.
std::optional<Plane> fit_plane(const Soup& soup, const std::vector<Index>& loop);

// Drops corners that repeat their neighbour and spikes without width; the loop may end up empty.
void clean_loop(std::vector<Index>& loop);

// Pairs of pieces whose boxes come within the tolerance.
Pairs near_pieces(const Soup& soup);

// Gives every piece a plane: near pieces whose corners lie within the tolerance of the plane of a
// larger one share that one's.
void find_planes(Soup& soup, const Pairs& near);

// Moves every point onto the planes that it touches, as far as they can all be met, those of
// larger pieces first. Numbers points anew.
void snap_to_planes(Soup& soup, const Pairs& near);

// Makes the edges of loops pass through all points within the tolerance of them.
void split_edges_at_points(Soup& soup, const Pairs& near);

// Adds a point where an edge crosses an edge or the inside of a piece, and splits the edges there.
void split_edges_at_crossings(Soup& soup, const Pairs& near);

// A segment or (a == b) a point that must appear in a plane's triangulation.
struct Contact {
    Index plane;
    Index a, b;
};

// Where pieces of different planes meet: every segment and point, once for either plane.
std::vector<Contact> find_contacts(const Soup& soup, const Pairs& near);

// A triangle of the complex to be.
struct Labelled {
    std::array<Index, 3> corners;
    std::vector<Owner> owners;  // ascending by polygon
};

// Triangulates every plane inside its pieces, through the contacts; adds points to the soup where
// contacts cross.
std::vector<Labelled> triangulate_planes(Soup& soup, const std::vector<Contact>& contacts);

// Whether x, in the piece's plane, is inside the piece or within the tolerance of its boundary.
bool holds(const Soup& soup, const Piece& piece, Point x);

}  // namespace tyndall::mesh::conforming
