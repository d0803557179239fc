#include "exports/coloured_surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <numbers>
#include <numeric>

#include "exports/ply_file.h"
#include "exports/spectra.h"
#include "mesh/input_error.h"
#include "radiosity/element_grid.h"
#include "render/tone_map.h"

namespace tyndall::exports {
namespace {

using mesh::Point;

// The patches of the grid: its first cells.
struct Surfaces {
    Triangles triangles;
    std::vector<double> radiance;     // of the points, a number a band [W/m^2/sr]
    std::vector<std::int32_t> sides;  // of the triangles
    std::size_t bands = 1;
};

Surfaces surfaces_of(const radiosity::ElementGrid& grid) {
    Surfaces result;
    result.bands = grid.bands;
    const auto count =
        static_cast<std::uint32_t>(std::ranges::count(grid.types, radiosity::vtk_triangle));
    for (std::size_t p = 0; p < 3 * count; ++p)
        result.triangles.points.push_back(
            {grid.points[3 * p], grid.points[3 * p + 1], grid.points[3 * p + 2]});
    for (std::uint32_t t = 0; t < count; ++t)
        result.triangles.corners.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    result.radiance.assign(grid.radiance.begin(), grid.radiance.begin() + 3 * count * grid.bands);
    const auto column =
        std::ranges::find(grid.cells, std::string("name_id"), &radiosity::CellColumn::name);
    const auto& sides = std::get<std::vector<std::int32_t>>(column->values);
    result.sides.assign(sides.begin(), sides.begin() + count);
    return result;
}

// As many pixels of one row as there are shares of the area.
render::Image picture_of(const Surfaces& surfaces) {
    constexpr std::size_t pixels = 4096;
    const auto& [points, corners] = surfaces.triangles;
    std::vector<double> ends;
    for (const auto& c : corners)
        ends.push_back(
            (ends.empty() ? 0.0 : ends.back()) +
            glm::length(glm::cross(points[c[1]] - points[c[0]], points[c[2]] - points[c[0]])));
    render::Image image{.width = pixels, .height = 1, .layers = {{"beauty", surfaces.bands, {}}}};
    for (std::size_t k = 0; k < pixels; ++k) {
        const double at = (double(k) + 0.5) / pixels * ends.back();
        const auto t = static_cast<std::size_t>(std::ranges::upper_bound(ends, at) - ends.begin());
        for (std::size_t b = 0; b < surfaces.bands; ++b) {
            double sum = 0.0;
            for (const auto corner : corners[t])
                sum += surfaces.radiance[corner * surfaces.bands + b];
            image.layers[0].values.push_back(static_cast<float>(sum / 3.0));
        }
    }
    return image;
}

// sRGB, 0 to 1, of every point; with other than three bands grey.
std::vector<std::array<double, 3>> colours_of(const Surfaces& surfaces,
                                              const render::ToneMapOptions& tone) {
    if (tone.white && !(*tone.white > 0.0))
        throw mesh::InputError(fmt::format(
            "render.white = {}: the radiance shown as white must be above 0.", *tone.white));
    std::vector<std::array<double, 3>> colours;
    if (surfaces.triangles.points.empty()) return colours;
    const auto picture = picture_of(surfaces);
    const double white = tone.white.value_or(render::automatic_white(picture, picture.layers[0]));
    const double factor = std::exp2(tone.exposure) / white;
    for (std::size_t p = 0; p < surfaces.triangles.points.size(); ++p) {
        Spectrum radiance(surfaces.radiance.begin() + p * surfaces.bands,
                          surfaces.radiance.begin() + (p + 1) * surfaces.bands);
        if (surfaces.bands != 3)
            radiance = {std::reduce(radiance.begin(), radiance.end()) / double(surfaces.bands)};
        std::array<double, 3> colour = rgb(radiance);
        for (double& c : colour)
            c = render::srgb_encode(render::tone_curve(tone.curve, factor * c));
        colours.push_back(colour);
    }
    return colours;
}

std::string material_file(const radiosity::Enclosure& e) {
    std::string text;
    const auto mean_or_rgb = [&](const Spectrum& values) {
        const bool grey = values.size() != 3;
        return rgb(grey
                       ? Spectrum{std::reduce(values.begin(), values.end()) / double(values.size())}
                       : values);
    };
    for (const auto& side : e.sides) {
        const auto d = mean_or_rgb(side.reflectance), l = mean_or_rgb(side.emission);
        text +=
            fmt::format("newmtl {}\nKd {:.6g} {:.6g} {:.6g}\nKe {:.6g} {:.6g} {:.6g}\nillum 1\n\n",
                        side.name, d[0], d[1], d[2], l[0], l[1], l[2]);
    }
    return text;
}

}  // namespace

ExportedFiles coloured_ply(const radiosity::Solution& solution,
                           const render::ToneMapOptions& tone) {
    const Surfaces surfaces = surfaces_of(radiosity::element_grid(solution));
    std::vector<std::array<std::uint8_t, 3>> codes;
    for (const auto& colour : colours_of(surfaces, tone)) {
        auto& code = codes.emplace_back();
        for (int k = 0; k < 3; ++k)
            code[k] = static_cast<std::uint8_t>(std::lround(255.0 * colour[k]));
    }
    std::vector<PointColumn> columns;
    for (std::size_t b = 0; b < surfaces.bands; ++b) {
        auto& column = columns.emplace_back();
        column.name = surfaces.bands == 1 ? "radiosity" : fmt::format("radiosity_{}", b);
        for (std::size_t p = 0; p < surfaces.triangles.points.size(); ++p)
            column.values.push_back(
                static_cast<float>(std::numbers::pi * surfaces.radiance[p * surfaces.bands + b]));
    }
    return {ply_file(surfaces.triangles, codes, columns), {}, {}};
}

ExportedFiles coloured_obj(const radiosity::Solution& solution, const std::string& stem,
                           const render::ToneMapOptions& tone) {
    const Surfaces surfaces = surfaces_of(radiosity::element_grid(solution));
    const auto colours = colours_of(surfaces, tone);
    const auto& [points, corners] = surfaces.triangles;
    std::string text = fmt::format("# Radiosity as colours of the points\nmtllib {}.mtl\n", stem);
    auto out = std::back_inserter(text);
    for (std::size_t p = 0; p < points.size(); ++p)
        fmt::format_to(out, "v {:.9g} {:.9g} {:.9g} {:.4f} {:.4f} {:.4f}\n", points[p].x,
                       points[p].y, points[p].z, colours[p][0], colours[p][1], colours[p][2]);
    // A group a side.
    std::vector<std::size_t> order(corners.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, {}, [&](std::size_t t) { return surfaces.sides[t]; });
    std::int32_t side = -1;
    for (const std::size_t t : order) {
        if (surfaces.sides[t] != side) {
            side = surfaces.sides[t];
            const auto& name = solution.enclosure->sides[static_cast<std::size_t>(side)].name;
            fmt::format_to(out, "g {0}\nusemtl {0}\n", name);
        }
        fmt::format_to(out, "f {} {} {}\n", corners[t][0] + 1, corners[t][1] + 1,
                       corners[t][2] + 1);
    }
    return {text, {{stem + ".mtl", material_file(*solution.enclosure)}}, {}};
}

}  // namespace tyndall::exports
