// A cube in whose rows everything occurs.
#pragma once

#include "support/box_mesh.h"
#include "support/catch.h"
#include "support/random_rays.h"

namespace tyndall::test {

// A cube whose medium, walls and openings make a row meet everything: a partition, an interface
// with empty space behind it, an opening in the hull.
inline radiosity::Enclosure crowded_cube() {
    using radiosity::none;
    auto enclosure = box_enclosure({{{0, 1, 2}, {0, 1, 2}, {0, 1, 2}}},
                                   [](Point c, int axis) -> std::optional<Face> {
                                       if (axis == 2 && c.z == 2.0 && c.x < 1.0)
                                           return std::nullopt;  // open
                                       if (axis == 0 && c.x == 1.0 && c.z < 1.0)
                                           return Face{mesh::Opacity::opaque, 0, 1};
                                       if (axis == 0 && c.x == 1.0)
                                           return Face{mesh::Opacity::interface};
                                       if (c[axis] == 0.0)
                                           return Face{mesh::Opacity::opaque, 0, none};
                                       if (c[axis] == 2.0)
                                           return Face{mesh::Opacity::opaque, none, 0};
                                       return std::nullopt;
                                   });
    enclosure.sides = {{"wall", 0, mesh::Side::front, {0.5}, {0.0}, 24.0},
                       {"back", 1, mesh::Side::front, {0.2}, {0.0}, 2.0}};
    enclosure.media = {{"haze", {0.3}, {0.9}, {0.0}, {0.03}}};
    // The right half is empty.
    REQUIRE(enclosure.mesh.region_count == 2);
    const auto& mesh = enclosure.mesh;
    enclosure.region_medium[mesh.regions[tet_at(mesh, {0.3, 0.3, 0.3}).value].value] = 0;
    return enclosure;
}

// Bisects the longest edges of zones and patches drawn by chance, `times` draws of each.
inline void bisect_some(radiosity::Forest& forest, int times) {
    Random random(1);
    for (int k = 0; k < times; ++k) {
        const mesh::ZoneId zone(index_below(random, forest.zone_count()));
        if (!forest.is_leaf(zone)) continue;
        const auto [i, j] = forest.longest_edge(zone);
        forest.bisect(zone, i, j);
    }
    for (int k = 0; k < times; ++k) {
        const mesh::PatchId patch(index_below(random, forest.patch_count()));
        if (!forest.is_leaf(patch)) continue;
        const auto [i, j] = forest.longest_edge(patch);
        forest.bisect(patch, i, j);
    }
}

}  // namespace tyndall::test
