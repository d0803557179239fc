#include "radiosity/scene_bands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <variant>

#include "mesh/input_error.h"

namespace tyndall::radiosity {
namespace {

enum class Needed { yes, no };

// Of whom the spectra are, for messages.
struct Owner {
    std::size_t bands;
    std::string name;  // "material \"plaster\"", with its place in front if it has one

    void complete(Spectrum& values, std::string_view what, Needed needed = Needed::no) const {
        if (values.empty() && needed == Needed::no) return;
        if (values.size() == 1) values.resize(bands, values[0]);
        if (values.size() != bands)
            throw mesh::InputError(fmt::format(
                "{} has {} value{} of {} for {} band{}. Give one for all bands, or one a band.",
                name, values.size(), values.size() == 1 ? "" : "s", what, bands,
                bands == 1 ? "" : "s"));
        if (!std::ranges::all_of(values, [](double v) { return std::isfinite(v); }))
            throw mesh::InputError(
                fmt::format("{} has a value of {} that is not finite. Give numbers.", name, what));
    }
};

Owner owner(const Scene& scene, std::string_view kind, const std::string& name,
            const std::string& where) {
    const std::string named = fmt::format("{} \"{}\"", kind, name);
    return {scene.bands, where.empty() ? named : where + ": " + named};
}

}  // namespace

Scene with_all_bands(Scene scene) {
    const bool in_total = scene.bands > 1 && !scene.spectral.empty();
    for (Material& material : scene.materials) {
        const Owner of = owner(scene, "material", material.name, material.where);
        of.complete(material.reflectance, "reflectance", Needed::yes);
        of.complete(material.specular, "specular reflectance");
        of.complete(material.emission, "emission");
        of.complete(material.power, "power");
        if (!in_total || material.flux.size() != 1) of.complete(material.flux, "flux");
    }
    for (Medium& medium : scene.media) {
        const Owner of = owner(scene, "medium", medium.name, medium.where);
        of.complete(medium.extinction, "extinction", Needed::yes);
        of.complete(medium.albedo, "albedo", Needed::yes);
        of.complete(medium.emission, "emission");
        if (!in_total || medium.heat.size() != 1) of.complete(medium.heat, "heat");
    }
    for (Light& light : scene.lights) {
        const Owner of = owner(scene, "light", light.name, light.where);
        if (auto* sun = std::get_if<Sun>(&light.source))
            of.complete(sun->irradiance, "irradiance", Needed::yes);
        if (auto* point = std::get_if<PointLight>(&light.source))
            of.complete(point->intensity, "intensity", Needed::yes);
        if (auto* spot = std::get_if<SpotLight>(&light.source))
            of.complete(spot->intensity, "intensity", Needed::yes);
    }
    Owner{scene.bands, "The environment"}.complete(scene.environment, "radiance");
    return scene;
}

}  // namespace tyndall::radiosity
