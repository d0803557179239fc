#include "radiosity/elements.h"

#include <glm/geometric.hpp>

namespace tyndall::radiosity {

std::uint32_t side_of(const Enclosure& enclosure, const Forest& forest, PatchId patch) {
    const std::uint32_t facet_side = forest.base_facet_side(patch);
    return enclosure.facet_sides[facet_side / 2][facet_side % 2];
}

std::uint32_t medium_of(const Enclosure& enclosure, const Forest& forest, ZoneId zone) {
    const TetId tet = forest.base_tet(zone);
    return enclosure.solid(tet) ? none : enclosure.medium_of(tet);
}

Direction normal_of(const Forest& forest, PatchId patch) {
    const auto& c = forest[patch].corners;
    const Point a = forest.point(c[0]);
    return glm::normalize(glm::cross(forest.point(c[1]) - a, forest.point(c[2]) - a));
}

Elements elements_of_leaves(const Enclosure& enclosure, const Forest& forest) {
    Elements e;
    e.bands = enclosure.bands;
    e.of_patch.assign(forest.patch_count(), none);
    e.of_zone.assign(forest.zone_count(), none);
    for (std::size_t p = 0; p < forest.patch_count(); ++p) {
        const PatchId patch(p);
        if (!forest.is_leaf(patch)) continue;
        const auto side = side_of(enclosure, forest, patch);
        if (side == none) continue;
        e.of_patch[p] = static_cast<std::uint32_t>(e.patches.size());
        e.patches.push_back(patch);
        const double area = forest.area(patch);
        for (std::size_t b = 0; b < e.bands; ++b) {
            e.capacity.push_back(area);
            e.scatter.push_back(enclosure.sides[side].reflectance[b]);
            e.emission.push_back(enclosure.sides[side].emission[b]);
        }
    }
    for (std::size_t z = 0; z < forest.zone_count(); ++z) {
        const ZoneId zone(z);
        if (!forest.is_leaf(zone)) continue;
        const auto medium = medium_of(enclosure, forest, zone);
        if (medium == none) continue;
        e.of_zone[z] = static_cast<std::uint32_t>(e.size());
        e.zones.push_back(zone);
        const double volume = forest.volume(zone);
        const auto& optics = enclosure.media[medium];
        for (std::size_t b = 0; b < e.bands; ++b) {
            e.capacity.push_back(4.0 * optics.extinction[b] * volume);
            e.scatter.push_back(optics.albedo[b]);
            e.emission.push_back(optics.emission[b]);
        }
    }
    return e;
}

}  // namespace tyndall::radiosity
