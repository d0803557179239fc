// Which corners of elements may share a value: those that meet at a vertex without a wall between.
//
// A value sampled once a vertex would leak through a partition whose two sides share its vertices.
// So the tets around a vertex fall into fans, connected through faces without an opaque facet, and
// the facet sides around it into fans connected through edges where the surface goes on flat and
// nothing stands on it.
#pragma once

#include <unordered_map>

#include "mesh/forest.h"

namespace tyndall::mesh {

// Cost: O(1) after the first question about a carrier; the first is a flood fill around it.
class Fans {
  public:
    explicit Fans(const BaseMesh& base);

    // The lowest tet of the fan of `tet` around a carrier of its vertices. Equal answers share a
    // value.
    TetId of_tet(const Carrier& carrier, TetId tet);
    // The lowest facet side (2 f + side) of the fan of `facet_side` around a carrier on its facet.
    std::uint32_t of_facet_side(const Carrier& carrier, std::uint32_t facet_side);

  private:
    struct Key {
        Carrier carrier;
        std::uint32_t member;
        bool operator==(const Key&) const = default;
    };
    struct Hash {
        std::size_t operator()(const Key& key) const noexcept;
    };
    using Cache = std::unordered_map<Key, std::uint32_t, Hash>;

    // The facet side that continues `facet_side` flat across edge (a, b); itself at a crease or
    // border.
    std::uint32_t across(std::uint32_t facet_side, VertexId a, VertexId b) const;
    const std::vector<FacetId>* facets_at(VertexId a, VertexId b) const;

    const BaseMesh& base_;
    std::unordered_map<std::uint64_t, std::vector<FacetId>> edge_facets_;  // opaque ones
    Cache tets_, facet_sides_;
};

}  // namespace tyndall::mesh
