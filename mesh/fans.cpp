#include "mesh/fans.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace tyndall::mesh {
namespace {

std::size_t count(const Carrier& carrier) {
    std::size_t n = 0;
    while (n < 4 && carrier[n].valid()) ++n;
    return n;
}

template <std::size_t N>
bool holds(const std::array<VertexId, N>& corners, const Carrier& carrier) {
    for (std::size_t k = 0; k < count(carrier); ++k)
        if (std::find(corners.begin(), corners.end(), carrier[k]) == corners.end()) return false;
    return true;
}

std::uint64_t edge_key(VertexId a, VertexId b) {
    if (b < a) std::swap(a, b);
    return std::uint64_t(a.value) << 32 | b.value;
}

}  // namespace

std::size_t Fans::Hash::operator()(const Key& key) const noexcept {
    std::uint64_t h = key.member;
    for (const VertexId v : key.carrier) h = (h ^ v.value) * 0x9e3779b97f4a7c15ull ^ (h >> 31);
    return h;
}

Fans::Fans(const BaseMesh& base) : base_(base) {
    for (std::size_t f = 0; f < base.facets.size(); ++f) {
        if (base.facets[f].opacity != Opacity::opaque) continue;
        const auto& c = base.facets[f].corners;
        for (int k = 0; k < 3; ++k)
            edge_facets_[edge_key(c[k], c[(k + 1) % 3])].push_back(FacetId(f));
    }
}

TetId Fans::of_tet(const Carrier& carrier, TetId tet) {
    if (count(carrier) == 4) return tet;
    if (const auto found = tets_.find({carrier, tet.value}); found != tets_.end())
        return TetId(found->second);
    std::vector<TetId> fan{tet};
    for (std::size_t n = 0; n < fan.size(); ++n) {
        const TetId at = fan[n];
        for (int k = 0; k < 4; ++k) {
            const TetId next = base_.neighbours[at.value][k];
            const FacetId facet = base_.tet_facets[at.value][k];
            if (!next.valid() || std::find(fan.begin(), fan.end(), next) != fan.end()) continue;
            if (facet.valid() && base_.facets[facet.value].opacity == Opacity::opaque) continue;
            // The shared face must hold the carrier, which it does if the next tet and this one do.
            const auto& corner = base_.tets[at.value][k];
            if (std::find(carrier.begin(), carrier.end(), corner) != carrier.end()) continue;
            if (holds(base_.tets[next.value], carrier)) fan.push_back(next);
        }
    }
    const TetId lowest = *std::min_element(fan.begin(), fan.end());
    for (const TetId member : fan) tets_[{carrier, member.value}] = lowest.value;
    return lowest;
}

const std::vector<FacetId>* Fans::facets_at(VertexId a, VertexId b) const {
    const auto found = edge_facets_.find(edge_key(a, b));
    return found == edge_facets_.end() ? nullptr : &found->second;
}

std::uint32_t Fans::across(std::uint32_t facet_side, VertexId a, VertexId b) const {
    const FacetId facet(facet_side / 2);
    const auto* facets = facets_at(a, b);
    if (!facets || facets->size() != 2) return facet_side;
    const FacetId other = (*facets)[0] == facet ? (*facets)[1] : (*facets)[0];
    const double cosine = glm::dot(normal(base_, facet), normal(base_, other));
    if (std::abs(cosine) < 1.0 - coplanar) return facet_side;
    // Neighbours that fold back onto each other are not one flat surface.
    const auto middle = [&](FacetId f) {
        const auto& c = base_.facets[f.value].corners;
        return (base_.points[c[0].value] + base_.points[c[1].value] + base_.points[c[2].value]) /
               3.0;
    };
    const Point p = base_.points[a.value], q = base_.points[b.value];
    const auto edge = q - p;
    if (glm::dot(glm::cross(edge, middle(facet) - p), glm::cross(edge, middle(other) - p)) > 0.0)
        return facet_side;
    return 2 * other.value + (cosine > 0.0 ? facet_side % 2 : 1 - facet_side % 2);
}

std::uint32_t Fans::of_facet_side(const Carrier& carrier, std::uint32_t facet_side) {
    if (count(carrier) >= 3) return facet_side;
    if (const auto found = facet_sides_.find({carrier, facet_side}); found != facet_sides_.end())
        return found->second;
    std::vector<std::uint32_t> fan{facet_side};
    for (std::size_t n = 0; n < fan.size(); ++n) {
        const auto& c = base_.facets[fan[n] / 2].corners;
        for (int k = 0; k < 3; ++k) {
            const VertexId a = c[k], b = c[(k + 1) % 3];
            if (!holds(std::array{a, b}, carrier)) continue;
            const std::uint32_t next = across(fan[n], a, b);
            if (std::find(fan.begin(), fan.end(), next) == fan.end()) fan.push_back(next);
        }
    }
    const std::uint32_t lowest = *std::min_element(fan.begin(), fan.end());
    for (const std::uint32_t member : fan) facet_sides_[{carrier, member}] = lowest;
    return lowest;
}

}  // namespace tyndall::mesh
