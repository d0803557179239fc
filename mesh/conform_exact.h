// The steps of `conform` that are done in exact arithmetic (CGAL), behind plain types.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <utility>
#include <vector>

#include "mesh/types.h"

namespace tyndall::mesh::conforming {

using Index = std::uint32_t;

// What lies in one plane: points, segments between them, and closed loops made of the segments.
struct PlanarSoup {
    std::vector<glm::dvec2> points;
    std::vector<std::array<Index, 2>> segments;
    std::vector<std::vector<Index>>
        segment_loops;  // loops that pass each segment an odd number of times
};

struct PlanarTriangles {
    std::vector<glm::dvec2> points;  // those of the soup, then the crossings of its segments
    std::vector<std::array<Index, 3>> triangles;  // counter-clockwise
    std::vector<std::vector<Index>> loops;        // the loops each triangle is inside of, ascending
};

// Purpose: constrained Delaunay triangulation of everything inside any loop (even-odd rule).
//   Crossings of segments are found exactly and rounded last.
// Cost: O(n log n) without crossings. Source: Boissonnat et al. (2002), CGAL's 2-D triangulations.
PlanarTriangles triangulate(const PlanarSoup& soup);

struct Box {
    Point min, max;
};

// All pairs (i < j) of boxes that touch, ascending. Cost: O(n log^3 n + pairs).
// Source: Zomorodian & Edelsbrunner (2002).
std::vector<std::pair<Index, Index>> touching_pairs(std::span<const Box> boxes);

// Pairs (i < j) of triangles that meet in more than shared corners and edges. Exact.
std::vector<std::pair<Index, Index>> crossing_pairs(
    std::span<const Point> points, std::span<const std::array<Index, 3>> triangles);

}  // namespace tyndall::mesh::conforming
