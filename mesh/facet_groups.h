// Facets of the conforming complex that need no edge between them.
#pragma once

#include <vector>

#include "mesh/conform.h"

namespace tyndall::mesh {

// Facets on the same polygons form one group: the edges between them are the triangulation's own
// choice. TetGen merges facets of one marker, which makes fewer and better tets.
class FacetGroups {
  public:
    explicit FacetGroups(const ConformingComplex& complex);
    // Groups given: of each facet, from 0 without gaps.
    FacetGroups(const ConformingComplex& complex, std::vector<std::size_t> groups);

    std::size_t size() const { return members_.size(); }
    std::size_t group(FacetId facet) const { return groups_[facet.value]; }
    const std::vector<FacetId>& members(std::size_t group) const { return members_[group]; }

    double area(std::size_t group) const;  // [m^2]

    // The member that x lies on, or else is nearest to. Cost: O(members).
    FacetId member_at(std::size_t group, Point x) const;

  private:
    glm::dvec3 area_vector(FacetId facet) const;

    const ConformingComplex& complex_;
    std::vector<std::size_t> groups_;
    std::vector<std::vector<FacetId>> members_;
};

}  // namespace tyndall::mesh
