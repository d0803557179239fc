// Elements of a solve as a structure of arrays: patches first, zones after, then outside.
#pragma once

#include <span>
#include <vector>

#include "mesh/clusters.h"
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
//
// An element is a leaf of the forest, or a cluster of its roots: base tets of one medium, facet
// sides of one side of a surface. `patches` and `zones` then name the first of its members.
struct Elements {
    std::size_t bands = 1;
    std::vector<PatchId> patches;            // element i < patches.size()
    std::vector<ZoneId> zones;               // element patches.size() + k
    std::vector<std::size_t> member_starts;  // of every element, into members; empty: no clusters
    std::vector<std::uint32_t> members;      // patch or zone nodes
    std::vector<double> member_ends;  // share of the element's area or volume up to and with it [-]
    // c: area, or 4 kappa_t volume [m^2]. Of a patch at which walks go on as at a mirror, the part
    // 1 − rho_m of its area, over which a and e are spread (63).
    std::vector<double> capacity;
    std::vector<double> scatter;   // a: reflectance, or albedo [-]
    std::vector<double> emission;  // e [W/m^2/sr]
    // rho_m of patches up to the last mirror [-].
    std::vector<double> mirrored;
    std::vector<std::uint32_t> of_patch;  // element of a patch node; none
    std::vector<std::uint32_t> of_zone;   // element of a zone node; none (empty space, inner nodes)

    std::size_t size() const { return patches.size() + zones.size(); }
    std::size_t outside() const { return size(); }
    bool is_patch(std::size_t element) const { return element < patches.size(); }
    // The part of its area that an element is spread over: 1 − rho_m of a mirror [-].
    double seen(std::size_t element, std::size_t band) const {
        const std::size_t k = element * bands + band;
        return k < mirrored.size() ? 1.0 - mirrored[k] : 1.0;
    }
    ZoneId zone(std::size_t element) const { return zones[element - patches.size()]; }
    // The patch or zone nodes that make up an element.
    std::span<const std::uint32_t> members_of(std::size_t element) const {
        if (member_starts.empty())
            return {is_patch(element) ? &patches[element].value
                                      : &zones[element - patches.size()].value,
                    1};
        return std::span(members).subspan(member_starts[element],
                                          member_starts[element + 1] - member_starts[element]);
    }
    // The members of all elements: nodes of the forest without a cluster among them.
    std::vector<PatchId> member_patches() const;
    std::vector<ZoneId> member_zones() const;

    // The member in which a place falls that is uniform over the element, given a number u in
    // [0, 1); u becomes the place's number within the member, again uniform in [0, 1), so that
    // what was stratified stays so.
    std::uint32_t pick_member(std::size_t element, double& u) const;
};

// The elements of the forest's leaves: every leaf on a side that light can reach, every leaf in a
// medium; tree by tree, so that elements that follow each other are near each other.
Elements elements_of_leaves(const Enclosure& enclosure, const Forest& forest);

// One element a cluster: every cluster that has no parent (mesh::make_whole_clusters). Roots of the
// forest that are in no cluster are no element's.
// Errors: mesh::InputError if a cluster holds more than one medium or surface side.
Elements elements_of_clusters(const Enclosure& enclosure, const Forest& forest,
                              const mesh::Clusters& clusters);

// What clusters must have in common: the medium of every base tet, the side of every facet side.
struct OpticalTags {
    explicit OpticalTags(const Enclosure& enclosure);
    operator mesh::ClusterTags() const { return {tets, facet_sides}; }

    std::vector<std::uint32_t> tets, facet_sides;
};

// Side of a surface that a patch belongs to; none where no light can be.
std::uint32_t side_of(const Enclosure& enclosure, const Forest& forest, PatchId patch);
// Medium of a zone; none in empty space and in solids.
std::uint32_t medium_of(const Enclosure& enclosure, const Forest& forest, ZoneId zone);
// What an empty zone of a medium whose extinction varies counts, of the medium's mean: nothing that
// could be seen, and enough for it to have a row, and so a value that gradients beside it can use.
inline constexpr double least_density = 1e-9;

// kappa_t in a zone of a medium: its mean, and the centre of its distribution, which is the
// centroid where it is uniform.
TetExtinction extinction_in(const Enclosure& enclosure, const Forest& forest, ZoneId zone,
                            std::size_t band);
// The mean over bands of a zone's kappa_t; by few points, where it varies [1/m].
double rough_extinction(const Enclosure& enclosure, const Forest& forest, ZoneId zone);
// Where an element's mean stands: the centroid; of a zone where kappa_t varies, which is met as
// often as it is dense, the centre of kappa_t, mean over bands.
Point centre_of(const Enclosure& enclosure, const Forest& forest, PatchId patch);
Point centre_of(const Enclosure& enclosure, const Forest& forest, ZoneId zone);
// What messages call an element: the side or medium it belongs to; "outside" for that.
std::string name_of(const Enclosure& enclosure, const Forest& forest, const Elements& elements,
                    ElementId element);
// The first band in which every medium has the extinction, and every mirror the reflectance, that
// it has in this one: exchange areas are the same in both.
std::size_t first_of_extinction(const Enclosure& enclosure, std::size_t band);
// Unit normal of a patch, away from the surface.
Direction normal_of(const Forest& forest, PatchId patch);

}  // namespace tyndall::radiosity
