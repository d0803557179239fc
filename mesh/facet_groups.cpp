#include "mesh/facet_groups.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <map>

namespace tyndall::mesh {

FacetGroups::FacetGroups(const ConformingComplex& complex) : complex_(complex) {
    std::map<std::vector<PolygonId>, std::size_t> known;
    for (std::size_t f = 0; f < complex.facets.size(); ++f) {
        const auto [found, added] = known.try_emplace(complex.facets[f].polygons, members_.size());
        if (added) {
            members_.emplace_back();
        }
        groups_.push_back(found->second);
        members_[found->second].push_back(FacetId(f));
    }
}

FacetGroups::FacetGroups(const ConformingComplex& complex, std::vector<std::size_t> groups)
    : complex_(complex), groups_(std::move(groups)) {
    for (std::size_t f = 0; f < groups_.size(); ++f) {
        if (groups_[f] >= members_.size()) {
            members_.resize(groups_[f] + 1);
        }
        members_[groups_[f]].push_back(FacetId(f));
    }
}

glm::dvec3 FacetGroups::area_vector(FacetId facet) const {
    const auto& corners = complex_.facets[facet.value].corners;
    const auto& a = complex_.points[corners[0].value];
    return 0.5 *
           glm::cross(complex_.points[corners[1].value] - a, complex_.points[corners[2].value] - a);
}

double FacetGroups::area(std::size_t group) const {
    double sum = 0.0;
    for (const auto facet : members_[group]) {
        sum += glm::length(area_vector(facet));
    }
    return sum;
}

FacetId FacetGroups::member_at(std::size_t group, Point x) const {
    FacetId best = members_[group].front();
    double most = -std::numeric_limits<double>::infinity();
    for (const auto facet : members_[group]) {
        if (members_[group].size() == 1) {
            break;
        }
        const auto& corners = complex_.facets[facet.value].corners;
        const auto normal = area_vector(facet);
        double inside = std::numeric_limits<double>::infinity();
        for (int k = 0; k < 3; ++k) {  // the least distance to an edge, negative outside
            const auto& a = complex_.points[corners[k].value];
            const auto along = complex_.points[corners[(k + 1) % 3].value] - a;
            const auto inward = glm::cross(normal, along);
            inside = std::min(inside, glm::dot(x - a, inward) / glm::length(inward));
        }
        if (inside > most) {
            most = inside;
            best = facet;
        }
    }
    return best;
}

}  // namespace tyndall::mesh
