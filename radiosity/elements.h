// Elements of a solve as a structure of arrays: patches first, zones after, then outside.
#pragma once

#include <span>
#include <vector>

#include "mesh/forest.h"
#include "radiosity/enclosure.h"

namespace tyndall::radiosity {

using mesh::Forest;
using mesh::PatchId;
using mesh::VertexId;
using mesh::ZoneId;
using ElementId = mesh::Id<struct ElementTag>;

// One entry an element, times `bands` where a value depends on the band ([element * bands + band]).
// Nothing that reads capacity, scatter and emission asks "surface or volume?" (docs/theory.md).
struct Elements {
    std::size_t bands = 1;
    std::vector<PatchId> patches;         // element i < patches.size()
    std::vector<ZoneId> zones;            // element patches.size() + k
    std::vector<double> capacity;         // c: area, or 4 kappa_t volume [m^2]
    std::vector<double> scatter;          // a: reflectance, or albedo [-]
    std::vector<double> emission;         // e [W/m^2/sr]
    std::vector<std::uint32_t> of_patch;  // element of a patch node; none
    std::vector<std::uint32_t> of_zone;   // element of a zone node; none (empty space, inner nodes)

    std::size_t size() const { return patches.size() + zones.size(); }
    std::size_t outside() const { return size(); }
    bool is_patch(std::size_t element) const { return element < patches.size(); }
    ZoneId zone(std::size_t element) const { return zones[element - patches.size()]; }
};

// The elements of the forest's leaves: every leaf on a side that light can reach, every leaf in a
// medium.
Elements elements_of_leaves(const Enclosure& enclosure, const Forest& forest);

// Side of a surface that a patch belongs to; none where no light can be.
std::uint32_t side_of(const Enclosure& enclosure, const Forest& forest, PatchId patch);
// Medium of a zone; none in empty space and in solids.
std::uint32_t medium_of(const Enclosure& enclosure, const Forest& forest, ZoneId zone);
// Unit normal of a patch, away from the surface.
Direction normal_of(const Forest& forest, PatchId patch);

}  // namespace tyndall::radiosity
