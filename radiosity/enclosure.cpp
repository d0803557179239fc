#include "radiosity/enclosure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "mesh/input_error.h"
#include "radiosity/enclosure_emissions.h"
#include "radiosity/medium_optics.h"
#include "radiosity/own_tetrahedra.h"
#include "radiosity/scene_bands.h"
#include "radiosity/steady_state.h"

namespace tyndall::radiosity {
namespace {

using mesh::BaseMesh;
using mesh::InputError;
using mesh::Opacity;

// A name and where it was defined, as messages give it.
std::string name_and_place(const std::string& what, const std::string& name,
                           const std::string& where) {
    return where.empty() ? fmt::format("{} \"{}\"", what, name)
                         : fmt::format("{}: {} \"{}\"", where, what, name);
}

struct Polygons {
    std::vector<mesh::Polygon> list;
    std::vector<std::size_t> surface;  // of each polygon
};

Polygons collect_polygons(const Scene& scene) {
    Polygons polygons;
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        const Surface& surface = scene.surfaces[s];
        for (mesh::Polygon polygon : surface.polygons) {
            polygon.opacity = surface.material ? Opacity::opaque : Opacity::interface;
            polygon.name =
                surface.where.empty() ? surface.name : surface.name + " (" + surface.where + ")";
            polygons.list.push_back(std::move(polygon));
            polygons.surface.push_back(s);
        }
    }
    return polygons;
}

// Along the polygon's front normal (Newell), twice its area long.
glm::dvec3 area_vector(const mesh::Polygon& polygon) {
    glm::dvec3 sum(0.0);
    const auto& c = polygon.corners;
    for (std::size_t k = 1; k + 1 < c.size(); ++k) sum += glm::cross(c[k] - c[0], c[k + 1] - c[0]);
    return sum;
}

Point position(const Light& light) {
    if (const auto* point = std::get_if<PointLight>(&light.source)) return point->position;
    if (const auto* spot = std::get_if<SpotLight>(&light.source)) return spot->position;
    return Point(0);
}

// The region that holds x; none outside the hull.
RegionId region_at(const BaseMesh& mesh, Point x) {
    const TetId tet = mesh::locate(mesh, x);
    return tet.valid() ? mesh.regions[tet.value] : RegionId();
}

// The opaque facet that x lies on within `tolerance` [m], if any.
FacetId wall_at(const BaseMesh& mesh, Point x, double tolerance) {
    const TetId tet = mesh::locate(mesh, x);
    if (!tet.valid()) return {};
    for (const FacetId facet : mesh.tet_facets[tet.value]) {
        if (!facet.valid()) continue;
        const Point corner = mesh.points[mesh.facets[facet.value].corners[0].value];
        if (std::abs(glm::dot(mesh::normal(mesh, facet), x - corner)) < tolerance) return facet;
    }
    return {};
}

// Binds the scene's optics to the mesh, step by step.
class Binder {
  public:
    Binder(const Scene& scene, const Polygons& polygons, const mesh::ConformingComplex& complex,
           const SampleOptions& sampling, Enclosure& enclosure)
        : scene_(scene),
          polygons_(polygons),
          complex_(complex),
          sampling_(sampling),
          e_(enclosure),
          mesh_(enclosure.mesh) {}

    void bind() {
        find_solids();
        fill_media();
        bind_sides();
    }

  private:
    const mesh::SideOwner& owner(FacetId facet, Side side) const {
        const auto& source = complex_.facets[mesh_.facets[facet.value].source.value];
        return side == Side::front ? source.front : source.back;
    }

    // Whether an opaque polygon on the facet has its back on this side. Where a box stands on a
    // floor, each turns its back to what the other one's front looks into: both sides are a
    // solid's.
    bool backs(FacetId facet, Side side) const {
        const auto& source = complex_.facets[mesh_.facets[facet.value].source.value];
        const Direction towards = (side == Side::front ? 1.0 : -1.0) * mesh::normal(mesh_, facet);
        return std::any_of(source.polygons.begin(), source.polygons.end(), [&](mesh::PolygonId id) {
            const mesh::Polygon& polygon = polygons_.list[id.value];
            return polygon.opacity == Opacity::opaque &&
                   glm::dot(area_vector(polygon), towards) < 0.0;
        });
    }

    void keep(RegionId region) {
        if (region.valid()) e_.region_solid[region.value] = false;
    }

    void find_solids() {
        std::vector<bool> has_back(mesh_.region_count), has_other(mesh_.region_count);
        for (std::size_t f = 0; f < mesh_.facets.size(); ++f) {
            const auto& facet = mesh_.facets[f];
            for (const Side side : {Side::front, Side::back}) {
                const TetId tet = facet.tets[side == Side::back];
                if (!tet.valid()) continue;
                const auto region = mesh_.regions[tet.value].value;
                const bool back = facet.opacity == Opacity::opaque && backs(FacetId(f), side);
                (back ? has_back : has_other)[region] = true;
            }
        }
        e_.region_solid.resize(mesh_.region_count);
        for (std::size_t r = 0; r < mesh_.region_count; ++r)
            e_.region_solid[r] = has_back[r] && !has_other[r];
        for (const Point eye : scene_.viewpoints) keep(region_at(mesh_, eye));
        for (const Light& light : scene_.lights)
            if (!std::holds_alternative<Sun>(light.source)) keep(region_at(mesh_, position(light)));
        for (const Medium& medium : scene_.media)
            if (medium.at) keep(region_at(mesh_, *medium.at));
        for (std::size_t t = 0; t < mesh_.tets.size(); ++t)
            for (const TetId next : mesh_.neighbours[t])
                if (!next.valid() && !e_.solid(TetId(t))) e_.open = true;
    }

    void fill_media() {
        e_.region_medium.assign(mesh_.region_count, none);
        std::vector<std::size_t> claimed(mesh_.region_count, scene_.media.size());
        const double tolerance = 1e-9 * glm::distance(mesh_.hull_min, mesh_.hull_max);
        for (std::size_t m = 0; m < scene_.media.size(); ++m) {
            const Medium& medium = scene_.media[m];
            e_.media.push_back(medium_optics(medium, e_));
            if (!medium.at) continue;
            const Point x = *medium.at;
            const RegionId region = region_at(mesh_, x);
            if (!region.valid())
                throw InputError(fmt::format(
                    "{} is to fill the region around at = [{}, {}, {}], which lies outside the "
                    "scene's hull. Give a point inside the region.",
                    name_and_place("medium", medium.name, medium.where), x.x, x.y, x.z));
            if (const FacetId wall = wall_at(mesh_, x, tolerance); wall.valid())
                throw InputError(fmt::format(
                    "{} is to fill the region around at = [{}, {}, {}], which lies on a surface{}. "
                    "Move the point into the region.",
                    name_and_place("medium", medium.name, medium.where), x.x, x.y, x.z,
                    on_surface(wall)));
            if (auto& claim = claimed[region.value]; claim != scene_.media.size())
                throw InputError(fmt::format(
                    "{} and medium \"{}\" claim one region by their points `at`. Remove one, or "
                    "put "
                    "a surface without material (an interface) between them.",
                    name_and_place("medium", medium.name, medium.where), scene_.media[claim].name));
            else
                claim = m;
        }
        for (std::size_t m = 0; m < scene_.media.size(); ++m)
            for (std::size_t r = 0; r < mesh_.region_count; ++r)
                if (claimed[r] == scene_.media.size() && !scene_.media[m].at && !e_.region_solid[r])
                    claimed[r] = m;
        bind_varying(scene_, claimed, sampling_, e_);
        for (std::size_t r = 0; r < mesh_.region_count; ++r) {
            if (claimed[r] == scene_.media.size()) continue;
            const auto& extinction = e_.media[claimed[r]].extinction;
            const bool empty = std::all_of(extinction.begin(), extinction.end(),
                                           [](double kappa) { return kappa == 0.0; });
            if (!empty) e_.region_medium[r] = static_cast<std::uint32_t>(claimed[r]);
        }
    }

    std::string on_surface(FacetId wall) const {
        const auto& polygons = complex_.facets[mesh_.facets[wall.value].source.value].polygons;
        if (polygons.empty()) return {};
        return fmt::format(" (\"{}\")", scene_.surfaces[polygons_.surface[polygons[0].value]].name);
    }

    // The side's optics but for its emission; `index` of (surface, side) is made when it first
    // faces light.
    std::uint32_t side_index(std::size_t surface, Side side) {
        auto& index = indices_[2 * surface + (side == Side::back)];
        if (index != none) return index;
        index = static_cast<std::uint32_t>(e_.sides.size());
        e_.sides.push_back(side_of_surface(scene_, e_, surface, side));
        return index;
    }

    void bind_sides() {
        indices_.assign(2 * scene_.surfaces.size(), none);
        e_.facet_sides.assign(mesh_.facets.size(), {none, none});
        for (std::size_t f = 0; f < mesh_.facets.size(); ++f) {
            if (mesh_.facets[f].opacity != Opacity::opaque) continue;
            for (const Side side : {Side::front, Side::back}) {
                const TetId tet = mesh_.facets[f].tets[side == Side::back];
                if (!tet.valid() || e_.solid(tet)) continue;
                const auto& own = owner(FacetId(f), side);
                const auto index = side_index(polygons_.surface[own.polygon.value], own.side);
                e_.facet_sides[f][side == Side::back] = index;
                e_.sides[index].area += mesh::area(mesh_, FacetId(f));
            }
        }
    }

    const Scene& scene_;
    const Polygons& polygons_;
    const mesh::ConformingComplex& complex_;
    const SampleOptions& sampling_;
    Enclosure& e_;
    const BaseMesh& mesh_;
    std::vector<std::uint32_t> indices_;  // 2 × surface + back → side
};

// What the solve takes for evenly scattered light.
void warn_of_directions(const Scene& scene, Enclosure& enclosure) {
    const auto warn = [&](std::string text) { enclosure.warnings.push_back(std::move(text)); };
    for (const Medium& medium : scene.media) {
        if (medium.asymmetry != 0.0)
            warn(fmt::format(
                "medium \"{}\" scatters anisotropically (g = {}): the solve and the line-of-sight "
                "picture use the reduced scattering coefficient (1 - g) kappa_s. Render by "
                "last_scatter, two_pass or path_traced for the phase function itself.",
                medium.name, medium.asymmetry));
        if (medium.phase == PhaseKind::rayleigh)
            warn(
                fmt::format("medium \"{}\" scatters by Rayleigh's phase function: the solve and "
                            "the line-of-sight picture scatter isotropically. Render by "
                            "last_scatter, two_pass or path_traced for the phase function itself.",
                            medium.name));
    }
    for (const Material& material : scene.materials) {
        if (std::ranges::none_of(material.specular, [](double rho) { return rho > 0.0; })) continue;
        if (material.roughness == 0.0 && enclosure.mirrors == Mirrors::walked) continue;
        warn(
            fmt::format("material \"{}\" has a {} part: the solve and the line-of-sight picture "
                        "scatter it evenly, as if it were reflectance. Render by two_pass or "
                        "path_traced for mirror images.",
                        material.name, material.roughness > 0.0 ? "glossy" : "specular"));
    }
}

bool asks_for_temperatures(const Scene& scene) {
    return scene.spectral.thermal(scene.bands) &&
           (scene.thermal ||
            std::ranges::any_of(scene.materials, [](const auto& m) { return !m.flux.empty(); }) ||
            std::ranges::any_of(scene.media, [](const auto& m) { return !m.heat.empty(); }));
}

}  // namespace

bool shines(const SurfaceSide& side) {
    const auto& e = side.emission;
    return std::ranges::any_of(e, [](double v) { return v > 0.0; }) &&
           std::ranges::none_of(e, [](double v) { return v < 0.0; });
}

Enclosure make_enclosure(const Scene& given, const EnclosureOptions& options) {
    const Scene scene = with_all_bands(given);
    const Polygons polygons = collect_polygons(scene);
    if (polygons.list.empty())
        throw InputError("The scene has no surfaces. Add at least one [[surface]].");
    const auto complex = mesh::conform(polygons.list, options.conform);
    Enclosure enclosure;
    enclosure.bands = scene.bands;
    enclosure.spectral = scene.spectral;
    enclosure.thermal = asks_for_temperatures(scene);
    enclosure.mirrors = options.mirrors;
    const bool own = !options.tetrahedra.empty();
    mesh::FittedMesh fitted =
        own ? mesh::fit_tetrahedra(mesh::read_tet_file(options.tetrahedra), complex, polygons.list,
                                   options.tetrahedralize)
            : mesh::FittedMesh{
                  mesh::tetrahedralize(complex, polygons.list, options.tetrahedralize), {}, {}};
    enclosure.mesh = std::move(fitted.mesh);
    mesh::find_regions(enclosure.mesh);
    Binder(scene, polygons, complex, options.extinction, enclosure).bind();
    bind_emissions(scene, enclosure);
    refuse_unsteady(scene, enclosure);
    if (own) note_own_tetrahedra(fitted, options.tetrahedra.string(), enclosure);
    warn_of_directions(scene, enclosure);
    return enclosure;
}

}  // namespace tyndall::radiosity
