// Cubes of unit cells with six walls and one medium, and sums over their exchange areas.
#pragma once

#include "radiosity/exchange_walked.h"
#include "support/box_mesh.h"

namespace tyndall::test {

struct Cube {
    double extinction = 1.0;           // [1/m]
    double albedo = 1.0;               // [-]
    double reflectance = 0.0;          // of all walls [-]
    double bottom_emission = 0.0;      // I_e of the wall z = 0 [W/m^2/sr]
    std::array<int, 3> size{1, 1, 1};  // [m]
    int cells = 1;                     // a metre
};

// Walls are sides 0 to 5: x = 0, x = far, y = 0, … Medium 0 fills everything, unless its extinction
// is 0.
inline radiosity::Enclosure cube_enclosure(const Cube& cube) {
    std::array<std::vector<double>, 3> lines;
    for (int a = 0; a < 3; ++a)
        for (int k = 0; k <= cube.size[a] * cube.cells; ++k)
            lines[a].push_back(double(k) / cube.cells);
    auto enclosure = box_enclosure(lines, [&](Point c, int axis) -> std::optional<Face> {
        const auto low = static_cast<std::uint32_t>(2 * axis);
        if (c[axis] == 0.0) return Face{mesh::Opacity::opaque, low, radiosity::none};
        if (c[axis] == cube.size[axis])
            return Face{mesh::Opacity::opaque, radiosity::none, low + 1};
        return std::nullopt;
    });
    for (std::size_t s = 0; s < 6; ++s) {
        const int a = (s / 2 + 1) % 3, b = (s / 2 + 2) % 3;
        enclosure.sides.push_back({"wall",
                                   s,
                                   mesh::Side::front,
                                   {cube.reflectance},
                                   {0.0},
                                   double(cube.size[a] * cube.size[b])});
    }
    enclosure.sides[4].emission = {cube.bottom_emission};
    if (cube.extinction > 0.0) {
        const double absorption = cube.extinction * (1.0 - cube.albedo);
        enclosure.media = {{"haze", {cube.extinction}, {cube.albedo}, {0.0}, {absorption}}};
        enclosure.region_medium.assign(enclosure.mesh.region_count, 0);
    }
    return enclosure;
}

// Names of groups of elements: wall 0 to 5, or 6 + the unit cell's index x + nx (y + ny z).
inline std::vector<std::size_t> groups_of(const radiosity::Enclosure& enclosure,
                                          const radiosity::Forest& forest,
                                          const radiosity::Elements& elements,
                                          const std::array<int, 3>& size) {
    std::vector<std::size_t> groups;
    for (const auto patch : elements.patches)
        groups.push_back(radiosity::side_of(enclosure, forest, patch));
    for (const auto zone : elements.zones) {
        const Point c = forest.centroid(zone);
        groups.push_back(6 + int(c.x) + size[0] * (int(c.y) + size[1] * int(c.z)));
    }
    return groups;
}

// Σ_i∈a Σ_j∈b S_ij of a method's rows, for all groups: [a][b].
inline std::vector<std::vector<double>> group_exchange(const Cube& cube,
                                                       radiosity::ExchangeMethod method,
                                                       const radiosity::ExchangeOptions& options) {
    const auto enclosure = cube_enclosure(cube);
    const radiosity::Forest forest(enclosure.mesh);
    const auto elements = radiosity::elements_of_leaves(enclosure, forest);
    const auto groups = groups_of(enclosure, forest, elements, cube.size);
    const std::size_t count = 6 + cube.size[0] * cube.size[1] * cube.size[2];
    const auto areas = radiosity::all_rows(method, {enclosure, forest, elements}, options);
    std::vector<std::vector<double>> sums(count, std::vector<double>(count, 0.0));
    for (std::size_t i = 0; i < areas.rows(); ++i)
        for (std::size_t k = areas.starts[i]; k < areas.starts[i + 1]; ++k)
            if (areas.columns[k] != elements.outside())
                sums[groups[i]][groups[areas.columns[k]]] += areas.values[k];
    return sums;
}

// The same of walked rows.
inline std::vector<std::vector<double>> group_exchange(
    const Cube& cube, std::size_t rays, std::uint64_t seed,
    const radiosity::ExchangeSettings& settings = {}) {
    return group_exchange(cube, radiosity::exchange_walked,
                          {.rays = rays, .seed = seed, .settings = settings, .progress = {}});
}

}  // namespace tyndall::test
