// What `conform` refuses, and how it says so.
#pragma once

#include <span>

#include "mesh/conform.h"
#include "mesh/conform_soup.h"
#include "mesh/polygon.h"

namespace tyndall::mesh::conforming {

// The diagonal [m] of the polygons' bounding box. Throws InputError unless every polygon has three
// finite corners, the diagonal is positive and finite, and 0 < tolerance < 0.01.
double check_corners(std::span<const Polygon> polygons, double tolerance);

// Throws InputError if the loop of a polygon has no area, is not planar or crosses itself.
void check_loop(const Soup& soup, const std::vector<Index>& loop, const Polygon& polygon,
                Index number);

// Throws InputError if the facets of a polygon do not add up to its area: its boundary overlaps
// itself.
void check_areas(const ConformingComplex& complex, std::span<const Polygon> polygons,
                 double tolerance);

// Throws InputError: two facets still cross after every round.
[[noreturn]] void throw_crossing(std::span<const Polygon> polygons, std::span<const Owner> first,
                                 std::span<const Owner> second, Point where);

}  // namespace tyndall::mesh::conforming
