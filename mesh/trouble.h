// Where a complex is hard to mesh: for messages only.
#pragma once

#include <optional>

#include "mesh/conform.h"

namespace tyndall::mesh {

struct Trouble {
    FacetId first, second;  // the same if one facet alone is at fault
    Point where;            // [m]
    double gap = 0.0;       // between the two [m]; 0 where they cross
};

// A pair of facets that cross or overlap, else the two that come nearest to each other without
// sharing a corner; none if nothing comes nearer than 1e-3 of the complex's diagonal.
std::optional<Trouble> find_trouble(const ConformingComplex& complex);

// The names of the polygons of some facets, at most six: "floor", "lamp" and 3 more.
std::string names_of(std::span<const FacetId> facets, const ConformingComplex& complex,
                     std::span<const Polygon> polygons);

}  // namespace tyndall::mesh
