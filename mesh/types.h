// Points, directions and typed indices that every folder shares.
#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <limits>

namespace tyndall::mesh {

// As a distance, a depth or a bound.
inline constexpr double infinity = std::numeric_limits<double>::infinity();

using Point = glm::dvec3;      // [m]
using Direction = glm::dvec3;  // unit length unless said otherwise [-]

// Index = identity. An Id is an index into one family of arrays; its type says which, so that a tet
// cannot be looked up among facets. A default-constructed Id is none.
template <class Tag>
struct Id {
    std::uint32_t value = std::numeric_limits<std::uint32_t>::max();

    constexpr Id() = default;
    constexpr explicit Id(std::uint64_t index) : value(static_cast<std::uint32_t>(index)) {}
    constexpr bool valid() const { return value != std::numeric_limits<std::uint32_t>::max(); }
    constexpr auto operator<=>(const Id&) const = default;
};

using VertexId = Id<struct VertexTag>;    // a point of a mesh
using PolygonId = Id<struct PolygonTag>;  // an input polygon
using FacetId = Id<struct FacetTag>;      // a triangle of the conforming complex or the base mesh
using TetId = Id<struct TetTag>;          // a base tetrahedron
using RegionId = Id<struct RegionTag>;    // tets connected without crossing a facet
using ZoneId = Id<struct ZoneTag>;        // a node of the tets' bisection trees: a tetrahedron
using PatchId = Id<struct PatchTag>;      // a node of the facet sides' bisection trees: a triangle

// A facet has two sides; its front is the side that its normal (right-hand rule) looks to.
enum class Side : std::uint8_t { front, back };

constexpr Side opposite(Side side) {
    return side == Side::front ? Side::back : Side::front;
}

}  // namespace tyndall::mesh

template <class Tag>
struct std::hash<tyndall::mesh::Id<Tag>> {
    std::size_t operator()(tyndall::mesh::Id<Tag> id) const noexcept { return id.value; }
};
