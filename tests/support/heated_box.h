// A box of grid cells with a black floor of radiance 1, a black cold ceiling, and a medium in
// radiative equilibrium (or one that scatters all: the same equation).
#pragma once

#include "support/box_mesh.h"

namespace tyndall::test {

// Reflectance of the four side walls along x and along y [-]; extinction of the medium [1/m].
struct HeatedBox {
    double reflectance_x = 1.0, reflectance_y = 1.0;
    double extinction = 1.0;
};

inline radiosity::Enclosure heated_box(const std::array<std::vector<double>, 3>& lines,
                                       const HeatedBox& box) {
    auto enclosure = box_enclosure(lines, [&](Point c, int axis) -> std::optional<Face> {
        const auto low = static_cast<std::uint32_t>(2 * axis);
        if (c[axis] == lines[axis].front())
            return Face{mesh::Opacity::opaque, low, radiosity::none};
        if (c[axis] == lines[axis].back())
            return Face{mesh::Opacity::opaque, radiosity::none, low + 1};
        return std::nullopt;
    });
    const Point size = enclosure.mesh.hull_max - enclosure.mesh.hull_min;
    const std::array<const char*, 6> names{"x0", "x1", "y0", "y1", "floor", "ceiling"};
    for (std::size_t s = 0; s < 6; ++s) {
        const double rho = s < 2 ? box.reflectance_x : s < 4 ? box.reflectance_y : 0.0;
        const double area = size.x * size.y * size.z / size[static_cast<int>(s / 2)];
        enclosure.sides.push_back({names[s], s, mesh::Side::front, {rho}, {0.0}, area});
    }
    enclosure.sides[4].emission = {1.0};
    enclosure.media = {{"gas", {box.extinction}, {1.0}, {0.0}, {box.extinction}}};
    enclosure.region_medium.assign(enclosure.mesh.region_count, 0);
    return enclosure;
}

// From −half to half: cells that grow from `least` in the middle outwards by `growth`.
inline std::vector<double> graded(double half, double least, double growth) {
    std::vector<double> right{0.5 * least};
    for (double cell = least * growth; right.back() + cell < half; cell *= growth)
        right.push_back(right.back() + cell);
    right.push_back(half);
    std::vector<double> lines;
    for (std::size_t k = right.size(); k-- > 0;) lines.push_back(-right[k]);
    lines.insert(lines.end(), right.begin(), right.end());
    return lines;
}

// From 0 to 1: cells that are thinnest at both ends (1 − cos).
inline std::vector<double> thin_at_ends(int cells) {
    std::vector<double> lines;
    for (int k = 0; k <= cells; ++k) lines.push_back(0.5 - 0.5 * std::cos(M_PI * k / cells));
    lines.front() = 0.0;
    lines.back() = 1.0;
    return lines;
}

}  // namespace tyndall::test
