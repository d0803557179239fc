#include "radiosity/enclosure_emissions.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numbers>

#include "mesh/input_error.h"
#include "radiosity/medium_optics.h"

namespace tyndall::radiosity {
namespace {

using mesh::InputError;

// The [[surface]] that a face belongs to: "lamp" of "lamp.top".
std::string whole_surface(const std::string& name) {
    return name.substr(0, name.find('.'));
}

InputError no_area(const Scene& scene, const std::string& name) {
    const auto surface = std::find_if(scene.surfaces.begin(), scene.surfaces.end(),
                                      [&](const auto& s) { return whole_surface(s.name) == name; });
    const std::string& where = surface->where;
    return InputError(fmt::format(
        "{}surface \"{}\" is to emit a power, but no part of its emitting side faces a region that "
        "light can be in. Turn it (front = right-hand rule of the corners), or set emits = "
        "\"both\".",
        where.empty() ? "" : where + ": ", name));
}

void bind_powers(const Scene& scene, Enclosure& e) {
    std::map<std::string, std::vector<std::size_t>> emitting;
    for (const Surface& surface : scene.surfaces)
        if (surface.material && !scene.materials[*surface.material].power.empty())
            emitting[whole_surface(surface.name)];
    for (std::size_t k = 0; k < e.sides.size(); ++k) {
        const Surface& surface = scene.surfaces[e.sides[k].surface];
        const auto side = material_of_side(scene, e.sides[k].surface, e.sides[k].side);
        const Material* own = &scene.materials[*surface.material];
        if (side.emits && side.material == own && !own->power.empty())
            emitting[whole_surface(surface.name)].push_back(k);
    }
    for (const auto& [name, sides] : emitting) {
        double area = 0.0;
        for (const auto k : sides) area += e.sides[k].area;
        if (!(area > 0.0)) throw no_area(scene, name);
        for (const auto k : sides) {
            const Spectrum& power =
                scene.materials[*scene.surfaces[e.sides[k].surface].material].power;
            for (std::size_t b = 0; b < e.bands; ++b)
                e.sides[k].emission[b] = power[b] / (std::numbers::pi * area);
        }
    }
}

}  // namespace

SideMaterial material_of_side(const Scene& scene, std::size_t surface, Side side) {
    const Material& material = scene.materials[*scene.surfaces[surface].material];
    if (side == Side::back && material.back) return {&scene.materials[*material.back], true};
    return {&material, side == Side::front || material.emits == EmittingSides::both};
}

SurfaceSide side_of_surface(const Scene& scene, const Enclosure& enclosure, std::size_t surface,
                            Side side) {
    const auto [material, emits] = material_of_side(scene, surface, side);
    SurfaceSide result;
    result.name = scene.surfaces[surface].name + (side == Side::front ? "+" : "-");
    result.surface = surface;
    result.side = side;
    result.reflectance = material->reflectance;
    result.specular = material->specular;
    result.roughness = material->roughness;
    for (std::size_t b = 0; b < result.specular.size(); ++b)
        result.reflectance[b] = std::min(1.0, result.reflectance[b] + result.specular[b]);
    for (const double rho : result.reflectance) result.emissivity.push_back(1.0 - rho);
    const bool given_flux = emits && !material->flux.empty();
    const bool reflects =
        std::ranges::any_of(material->specular, [](double rho) { return rho > 0.0; });
    if (enclosure.mirrors == Mirrors::walked && material->roughness == 0.0 && reflects &&
        !given_flux)
        for (const double rho : material->specular)
            result.mirror.push_back(std::min(rho, 1.0 - least_seen));
    if (given_flux) {
        if (enclosure.settles())
            result.settled_flux = material->flux[0];
        else
            result.reflectance.assign(enclosure.bands, 1.0);
    }
    return result;
}

void bind_emissions(const Scene& scene, Enclosure& e) {
    for (SurfaceSide& side : e.sides) {
        const auto [material, emits] = material_of_side(scene, side.surface, side.side);
        side.emission =
            emits && !material->emission.empty() ? material->emission : Spectrum(e.bands, 0.0);
        if (emits && !material->flux.empty() && !e.settles())
            for (std::size_t b = 0; b < e.bands; ++b)
                side.emission[b] = material->flux[b] / std::numbers::pi;
    }
    bind_powers(scene, e);
    for (std::size_t m = 0; m < e.media.size(); ++m)
        e.media[m].emission = medium_optics(scene.media[m], e).emission;
    e.lights = scene.lights;
    e.environment = scene.environment.empty() ? Spectrum(e.bands, 0.0) : scene.environment;
}

}  // namespace tyndall::radiosity
