// Where a picture looks at the light that arrives in a solution: corners of nodes of media and of
// surfaces.
#pragma once

#include <array>
#include <vector>

#include "radiosity/gather.h"
#include "radiosity/solution.h"

namespace tyndall::render {

struct ArrivingPlacesOptions {
    // Zones stand together in nodes of the forest whose longest edge is below this share of their
    // medium's diagonal; leaves that are larger stand alone [-].
    double group = 0.12;
    double patch_group = 0.04;  // the same of patches, of the mesh's diagonal [-]
    // The same of nodes with a leaf in which direct light is more than indirect: what is scattered
    // forwards there is as narrow as shafts are.
    double lit_group = 0.05, lit_patch_group = 0.015;  // [-]
    // Zones at a distance d from a patch that is lit so are smaller than `near` × d, too, but need
    // not be smaller than `least` of the diagonal: from one place to the next the patch is seen in
    // another direction [-].
    double near = 0.3, least = 0.02;
};

struct ArrivingPlaces {
    std::vector<radiosity::GatherPoint> places;  // those in media first
    std::size_t in_media = 0;
    std::vector<std::uint32_t> zone_groups, patch_groups;    // of nodes; none
    std::vector<std::array<std::uint32_t, 4>> zone_corners;  // of groups: places
    std::vector<std::array<std::uint32_t, 3>> patch_corners;
    std::vector<mesh::ZoneId> zones;  // leaves that are in a group, and which
    std::vector<std::uint32_t> group_of_zone;
};

// Purpose: places at the corners of groups of zones in media that do not scatter evenly and, if
//   there are any, of patches that reflect, wherever they are.
// Places on walls are a little off their corner, towards the group's middle: no ray starts on a
// wall's edge, and groups on two sides of a wall have places of their own.
// Cost: the nodes above groups, times the lit leaves on patches.
ArrivingPlaces arriving_places(const radiosity::Solution& solution,
                               const ArrivingPlacesOptions& options = {});

}  // namespace tyndall::render
