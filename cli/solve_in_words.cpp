#include "cli/solve_in_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>

namespace tyndall::cli {
namespace {

using radiosity::Refinement;
using radiosity::SolveOptions;
using radiosity::Start;

std::string start_text(const SolveOptions& options) {
    if (options.start == Start::single_zone)
        return "one zone a medium, the input polygons as patches";
    if (options.start == Start::mesh) return "your own tetrahedra";
    if (options.element_size > 0.0)
        return fmt::format("elements of at most {:g} m", options.element_size);
    if (options.start == Start::base || options.refinement == Refinement::none)
        return "the base tetrahedra and facets";
    return "some 4000 zones and 1500 patches, where the base mesh has fewer";
}

std::string refinement_text(const SceneFile& file) {
    const SolveOptions& options = file.solve;
    const bool viewed = !file.view_camera.empty() && options.refinement >= Refinement::view;
    if (options.refinement < Refinement::adaptive) return "these are kept as they are";
    std::string text = "bisected where light departs from linear";
    if (viewed) text += fmt::format(" in what camera \"{}\" sees", file.view_camera);
    if (options.refinement == Refinement::aligned) text += ", and along the edges of shadows";
    return text;
}

std::string goal_text(const SceneFile& file) {
    const SolveOptions& options = file.solve;
    if (options.refinement < Refinement::adaptive) return "none: the mesh is given";
    const bool viewed = !file.view_camera.empty() && options.refinement >= Refinement::view;
    auto text = fmt::format("{:.3g} % estimated error of the {}; at most {} elements, {:.3g} GB",
                            100.0 * options.error, viewed ? "picture" : "solution everywhere",
                            options.max_elements, double(options.max_memory) / 1e9);
    if (options.max_time > 0.0) text += fmt::format(", {:g} s", options.max_time);
    return text;
}

std::string methods_text(const SolveOptions& options) {
    auto text = fmt::format("exchange areas {}", options.exchange);
    if (options.exchange == "walked") text += fmt::format(", {} rays an element", options.rays);
    text += fmt::format("; solver {}; direct light of surfaces {}", options.solver,
                        options.direct_light == radiosity::DirectLightMode::closed_form
                            ? "in closed form"
                            : "through the exchange areas");
    return text;
}

std::string picture_text(const SceneFile& file) {
    if (file.cameras.empty()) return "none: the scene has no camera";
    const auto& camera = find_camera(file.cameras, file.view_camera);
    return fmt::format("{} x {} of camera \"{}\" by {}, {} samples a pixel", camera.width,
                       camera.height, camera.name, file.render.method, file.render.samples);
}

std::string bands_text(const radiosity::Enclosure& e) {
    if (!e.spectral.grey_gases.gases.empty())
        return fmt::format("{}: a clear gas and {} grey ones", e.bands, e.bands - 1);
    if (!e.spectral.band_edges.empty())
        return fmt::format("{}, between wavelengths of {:.3g} and {:.3g} µm", e.bands,
                           1e6 * e.spectral.band_edges.front(), 1e6 * e.spectral.band_edges.back());
    return e.bands == 1 ? "1, grey" : fmt::format("{}", e.bands);
}

// Surfaces of each medium [m^2]: walls, once a side, and faces towards what is not it.
std::vector<double> medium_surfaces(const radiosity::Enclosure& e) {
    std::vector<double> areas(e.media.size(), 0.0);
    const auto medium_at = [&](mesh::TetId tet) {
        return tet.valid() ? e.medium_of(tet) : radiosity::none;
    };
    for (std::size_t f = 0; f < e.mesh.facets.size(); ++f) {
        const auto& facet = e.mesh.facets[f];
        const bool opaque = facet.opacity == mesh::Opacity::opaque;
        for (const int k : {0, 1}) {
            const auto medium = medium_at(facet.tets[k]);
            if (medium != radiosity::none && (opaque || medium != medium_at(facet.tets[1 - k])))
                areas[medium] += mesh::area(e.mesh, mesh::FacetId(f));
        }
    }
    for (std::size_t t = 0; t < e.mesh.tets.size(); ++t)
        for (int k = 0; k < 4; ++k) {
            const auto medium = e.medium_of(mesh::TetId(t));
            if (medium == radiosity::none || e.mesh.neighbours[t][k].valid() ||
                e.mesh.tet_facets[t][k].valid())
                continue;
            const auto corner = [&](int c) {
                return e.mesh.points[e.mesh.tets[t][(k + c) % 4].value];
            };
            areas[medium] +=
                0.5 * glm::length(glm::cross(corner(2) - corner(1), corner(3) - corner(1)));
        }
    return areas;
}

}  // namespace

std::vector<MediumThickness> media_thickness(const radiosity::Enclosure& e) {
    std::vector<double> volumes(e.media.size(), 0.0);
    for (std::size_t t = 0; t < e.mesh.tets.size(); ++t)
        if (const auto medium = e.medium_of(mesh::TetId(t)); medium != radiosity::none)
            volumes[medium] += mesh::volume(e.mesh, mesh::TetId(t));
    const auto areas = medium_surfaces(e);
    std::vector<MediumThickness> result;
    for (std::size_t m = 0; m < e.media.size(); ++m) {
        const auto& medium = e.media[m];
        MediumThickness thickness{medium.name, areas[m] > 0.0 ? 4.0 * volumes[m] / areas[m] : 0.0};
        const auto [low, high] = std::ranges::minmax(medium.extinction);
        thickness.thinnest = low * thickness.chord;
        thickness.thickest = high * thickness.chord;
        for (const double albedo : medium.albedo)
            thickness.albedo += albedo / static_cast<double>(medium.albedo.size());
        result.push_back(thickness);
    }
    return result;
}

std::string in_words(const MediumThickness& m) {
    struct Class {
        double below;
        const char* words;
    };
    constexpr Class classes[]{
        {1e-300, "clear"},
        {0.1, "very thin: light mostly passes"},
        {0.5, "thin: light is met once at most"},
        {2.0, "moderate: light is met about once"},
        {10.0, "thick: light is met several times"},
        {1e300, "very thick: light diffuses; look at fluxes with care"},
    };
    const auto* found =
        std::ranges::find_if(classes, [&](const Class& one) { return m.thickest < one.below; });
    const auto thickness = m.thinnest == m.thickest
                               ? fmt::format("{:.2g}", m.thickest)
                               : fmt::format("{:.2g} to {:.2g}", m.thinnest, m.thickest);
    return fmt::format(
        "{}, {}; optical thickness {} along the mean chord of {:.3g} m, albedo {:.3g}", m.name,
        found->words, thickness, m.chord, m.albedo);
}

std::vector<std::pair<std::string, std::string>> solve_in_words(const SceneFile& file,
                                                                const radiosity::Enclosure& e) {
    return {{"start", start_text(file.solve)}, {"refined", refinement_text(file)},
            {"goal", goal_text(file)},         {"methods", methods_text(file.solve)},
            {"picture", picture_text(file)},   {"bands", bands_text(e)}};
}

}  // namespace tyndall::cli
