#include "view/report_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "view/markup.h"

namespace tyndall::view {
namespace {

using radiosity::Enclosure;
using radiosity::MediumOptics;
using radiosity::Spectrum;
using radiosity::SurfaceSide;
using std::numbers::pi;

constexpr double rounding = 1e-9;  // of a sum of shares

// One number where all bands are alike, else one a band; of many bands the least and the most.
std::string spectrum_text(const Spectrum& values) {
    constexpr std::size_t most = 6;
    if (values.empty()) return "0";
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    if (*low == *high) return figure(*low);
    if (values.size() > most) return figure(*low) + " to " + figure(*high);
    std::string text;
    for (const double value : values) text += (text.empty() ? "" : ", ") + figure(value);
    return text;
}

Spectrum mapped(std::size_t bands, auto&& value) {
    Spectrum result(bands);
    for (std::size_t b = 0; b < bands; ++b) result[b] = value(b);
    return result;
}

bool any_positive(const Spectrum& values) {
    return std::any_of(values.begin(), values.end(), [](double v) { return v > 0.0; });
}

std::string point_text(glm::dvec3 p) {
    return fmt::format("({}, {}, {})", figure(p.x), figure(p.y), figure(p.z));
}

// What a side gives by itself. Where a flux is given, e of the one equation is q/π.
std::string given_by(const SurfaceSide& side, std::size_t bands) {
    if (side.settled_flux) return figure(*side.settled_flux) + " W/m² net";
    bool flux = false;
    for (std::size_t b = 0; b < side.emissivity.size(); ++b)
        flux = flux || side.reflectance[b] + side.emissivity[b] > 1.0 + rounding;
    if (flux)
        return spectrum_text(mapped(bands, [&](std::size_t b) { return pi * side.emission[b]; })) +
               " W/m² net";
    return any_positive(side.emission) ? spectrum_text(side.emission) + " W/(m² sr)" : "–";
}

std::string reflectance_of(const SurfaceSide& side, std::size_t bands) {
    if (side.emissivity.empty()) return spectrum_text(side.reflectance);
    return spectrum_text(mapped(bands, [&](std::size_t b) { return 1.0 - side.emissivity[b]; }));
}

std::string surfaces_table(const Enclosure& e, const ReportPageOptions& options) {
    Table table{"Surfaces: sides that light can reach", {"side"}, {}};
    const bool named = !options.materials.empty();
    if (named) table.heads.push_back("material");
    table.heads.insert(table.heads.end(), {"area [m²]", "reflectance", "of it specular", "gives"});
    for (const auto& side : e.sides) {
        std::vector<std::string> row{side.name};
        if (named) {
            const auto found = options.materials.find(side.name);
            row.push_back(found == options.materials.end() ? "–" : found->second);
        }
        row.insert(row.end(), {figure(side.area), reflectance_of(side, e.bands),
                               side.specular.empty() ? "–" : spectrum_text(side.specular),
                               given_by(side, e.bands)});
        table.rows.push_back(row);
    }
    return table_markup(table);
}

// Ω, where heat is given too: then a of the one equation is 1.
Spectrum albedo_of(const MediumOptics& medium, std::size_t bands) {
    return mapped(bands, [&](std::size_t b) {
        return medium.extinction[b] > 0.0 ? 1.0 - medium.absorption[b] / medium.extinction[b] : 0.0;
    });
}

std::string given_by(const MediumOptics& medium, std::size_t bands) {
    if (medium.settled_heat) return figure(*medium.settled_heat) + " W/m³";
    const Spectrum albedo = albedo_of(medium, bands);
    bool heat = false;
    for (std::size_t b = 0; b < bands; ++b) heat = heat || medium.albedo[b] > albedo[b] + rounding;
    if (heat)
        return spectrum_text(mapped(bands,
                                    [&](std::size_t b) {
                                        return 4.0 * pi * medium.extinction[b] * medium.emission[b];
                                    })) +
               " W/m³";
    if (!any_positive(medium.emission)) return "–";
    return spectrum_text(mapped(bands,
                                [&](std::size_t b) {
                                    return medium.absorption[b] > 0.0
                                               ? medium.emission[b] * medium.extinction[b] /
                                                     medium.absorption[b]
                                               : 0.0;
                                })) +
           " W/(m² sr)";
}

std::string scattering_of(const MediumOptics& medium) {
    if (medium.phase.kind == radiosity::PhaseKind::rayleigh) return "Rayleigh";
    if (medium.phase.isotropic()) return "isotropic";
    return fmt::format("Henyey–Greenstein, g = {}", figure(medium.phase.asymmetry));
}

std::string media_table(const Enclosure& e, const std::map<std::string, NamedSize>& sizes) {
    const auto chords = mean_chords(e);
    Table table{
        "Media as they are solved: extinction and albedo of forward scattering ones are reduced",
        {"medium", "volume [m³]", "extinction [1/m]", "albedo", "scattering", "mean chord [m]",
         "optical thickness of it", "gives"},
        {}};
    for (std::size_t m = 0; m < e.media.size(); ++m) {
        const MediumOptics& medium = e.media[m];
        const auto thickness =
            mapped(e.bands, [&](std::size_t b) { return medium.extinction[b] * chords[m]; });
        const std::string varies = medium.varying.empty() ? "" : ", in the mean";
        table.rows.push_back({medium.name, figure(sizes.at(medium.name).size),
                              spectrum_text(medium.extinction) + varies,
                              spectrum_text(albedo_of(medium, e.bands)), scattering_of(medium),
                              figure(chords[m]), spectrum_text(thickness),
                              given_by(medium, e.bands)});
    }
    return table_markup(table);
}

std::vector<std::string> light_row(const radiosity::Light& light) {
    if (const auto* sun = std::get_if<radiosity::Sun>(&light.source))
        return {light.name, "sun", "shines along " + point_text(sun->direction),
                spectrum_text(sun->irradiance) + " W/m²"};
    if (const auto* point = std::get_if<radiosity::PointLight>(&light.source))
        return {light.name, "point", "at " + point_text(point->position),
                spectrum_text(point->intensity) + " W/sr"};
    const auto& spot = std::get<radiosity::SpotLight>(light.source);
    return {light.name, "spot",
            fmt::format("at {}, along {}, {}° wide", point_text(spot.position),
                        point_text(spot.direction), figure(spot.angle * 180.0 / pi)),
            spectrum_text(spot.intensity) + " W/sr"};
}

std::string lights_table(const Enclosure& e) {
    Table table{"Lights beside surfaces and media that emit",
                {"light", "kind", "place", "gives"},
                {},
                false};
    for (const auto& light : e.lights) table.rows.push_back(light_row(light));
    if (any_positive(e.environment))
        table.rows.push_back({"environment", "from everywhere outside", "–",
                              spectrum_text(e.environment) + " W/(m² sr)"});
    return table_markup(table);
}

std::string cameras_table(const ReportPageOptions& options) {
    Table table{
        "Cameras", {"camera", "projection", "from", "to", "pixels", "solved for"}, {}, false};
    for (const auto& camera : options.cameras) {
        using radiosity::PictureProjection;
        const char* projection = camera.projection == PictureProjection::perspective ? "perspective"
                                 : camera.projection == PictureProjection::orthographic
                                     ? "orthographic"
                                     : "panorama";
        table.rows.push_back({camera.name, projection, point_text(camera.eye),
                              point_text(camera.target),
                              fmt::format("{} × {}", camera.width, camera.height),
                              camera.name == options.view_camera ? "yes" : "no"});
    }
    return table_markup(table);
}

}  // namespace

std::vector<double> mean_chords(const Enclosure& e) {
    std::vector<double> volumes(e.media.size(), 0.0), surfaces(e.media.size(), 0.0);
    for (std::size_t t = 0; t < e.mesh.tets.size(); ++t) {
        const mesh::TetId tet(t);
        const auto medium = e.medium_of(tet);
        if (medium == radiosity::none || e.solid(tet)) continue;
        volumes[medium] += mesh::volume(e.mesh, tet);
        for (int k = 0; k < 4; ++k) {
            const auto next = e.mesh.neighbours[t][k];
            const auto facet = e.mesh.tet_facets[t][k];
            const bool wall =
                facet.valid() && e.mesh.facets[facet.value].opacity == mesh::Opacity::opaque;
            if (!wall && next.valid() && e.medium_of(next) == medium) continue;
            const auto& f = mesh::face_corners[k];
            const auto corner = [&](int c) { return e.mesh.points[e.mesh.tets[t][f[c]].value]; };
            surfaces[medium] +=
                0.5 * glm::length(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
        }
    }
    for (std::size_t m = 0; m < volumes.size(); ++m)
        volumes[m] = surfaces[m] > 0.0 ? 4.0 * volumes[m] / surfaces[m] : 0.0;
    return volumes;
}

std::string scene_tables(const radiosity::Solution& solution, const ReportFacts& facts,
                         const ReportPageOptions& options,
                         const std::map<std::string, NamedSize>& sizes) {
    const Enclosure& e = *solution.enclosure;
    Table table{"The scene", {"what", "value"}, {}, false};
    const auto add = [&](const char* name, const std::string& value) {
        table.rows.push_back({name, value});
    };
    add("title", options.title);
    if (!facts.scene.empty()) add("file", facts.scene);
    add("hull", point_text(e.mesh.hull_min) + " to " + point_text(e.mesh.hull_max) + " m");
    add("open", e.open ? "yes: light leaves through the hull" : "no: no light leaves it");
    add("bands", std::to_string(e.bands));
    add("base mesh", fmt::format("{} tetrahedra, {} triangles of surfaces", e.mesh.tets.size(),
                                 e.mesh.facets.size()));
    return table_markup(table) + surfaces_table(e, options) + media_table(e, sizes) +
           lights_table(e) + cameras_table(options);
}

}  // namespace tyndall::view
