#include "cli/scene_optics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "cli/scene_extinction.h"
#include "cli/scene_keys.h"

namespace tyndall::cli {
namespace {

using radiosity::Spectrum;
using std::numbers::pi;

constexpr Range kelvin{0.0, 1e6};
constexpr Range signed_quantity{-1e30, 1e30};
constexpr double degree = pi / 180.0;  // [rad]

std::string named(std::string_view kind, const std::string& name) {
    return fmt::format("{} \"{}\"", kind, name);
}

// What a key of heat finds in the scene: its bands, and where to say what was mended.
struct Heat {
    radiosity::Scene& scene;
    std::vector<std::string>& notes;
};

// The share of σT⁴/π in each band [W/m²/sr].
Spectrum black_radiance(const TableReader& reader, const Heat& heat) {
    const std::size_t bands = heat.scene.bands;
    const radiosity::SpectralModel& model = heat.scene.spectral;
    if (!model.thermal(bands)) {
        reader.fail("temperature",
                    fmt::format("temperature of {} needs to know what the {} bands are. Give the "
                                "scene band_edges or grey_gases, or give emission, one value a "
                                "band.",
                                reader.thing(), bands));
    }
    heat.scene.thermal = true;
    const double kelvins = reader.number("temperature", kelvin);
    const auto& grey = model.grey_gases;
    if (!grey.gases.empty() && kelvins > 0.0 && (kelvins < grey.lowest || kelvins > grey.highest))
        heat.notes.push_back(fmt::format(
            "temperature {} K of {} is beyond {} to {} K, which the weights of '{}' are for: those "
            "of the nearer end are taken",
            kelvins, reader.thing(), grey.lowest, grey.highest, grey.name));
    return radiosity::black_radiance(model, bands, kelvins);
}

// A flux or a heat source: one value a band, or one for all bands that have wavelengths or weights.
Spectrum read_total(const TableReader& reader, std::string_view key, const Range& range,
                    const radiosity::Scene& scene) {
    if (scene.bands == 1 || scene.spectral.empty()) return reader.spectrum(key, scene.bands, range);
    if (reader.node(key).is_array())
        reader.fail(key, fmt::format("{} of {} is that of all bands together, as the scene says "
                                     "what they are. Give one number.",
                                     key, reader.thing()));
    return {reader.number(key, range)};
}

// 1 − ρ of all reflection, which is the emissivity.
double absorbed(const radiosity::Material& material, std::size_t band) {
    const double specular = material.specular.empty() ? 0.0 : material.specular[band];
    return std::max(0.0, 1.0 - material.reflectance[band] - specular);
}

void read_emission(const TableReader& reader, const Heat& heat, radiosity::Material& material) {
    const std::size_t bands = heat.scene.bands;
    constexpr std::array<std::string_view, 5> sources{"emission", "exitance", "power",
                                                      "temperature", "flux"};
    const auto source = reader.at_most_one(sources);
    if (source == "emission") {
        material.emission = reader.spectrum("emission", bands, quantity);
    } else if (source == "exitance") {
        material.emission = reader.spectrum("exitance", bands, quantity);
        for (double& value : material.emission) value /= pi;
    } else if (source == "power") {
        material.power = reader.spectrum("power", bands, quantity);
    } else if (source == "temperature") {
        material.emission = black_radiance(reader, heat);
        for (std::size_t b = 0; b < bands; ++b) material.emission[b] *= absorbed(material, b);
        material.emits = radiosity::EmittingSides::both;
    } else if (source == "flux") {
        material.flux = read_total(reader, "flux", signed_quantity, heat.scene);
        material.emits = radiosity::EmittingSides::both;
    }
    constexpr std::array<std::string_view, 2> sides{"front", "both"};
    if (reader.has("emits")) {
        material.emits = static_cast<radiosity::EmittingSides>(reader.choice("emits", sides));
    }
}

// A chain of back sides may not come round to where it began.
void check_back(const TableReader& reader, const std::vector<radiosity::Material>& materials,
                std::size_t first) {
    std::string chain = "\"" + materials[first].name + "\"";
    auto next = materials[first].back;
    for (std::size_t step = 0; next && step < materials.size(); ++step) {
        chain += fmt::format(" → \"{}\"", materials[*next].name);
        if (*next == first) {
            reader.fail("back",
                        fmt::format("back of {} leads to itself: {}. Name a material without "
                                    "such a back.",
                                    reader.thing(), chain));
        }
        next = materials[*next].back;
    }
}

void read_phase(const TableReader& reader, radiosity::Medium& medium) {
    if (!reader.has("phase")) return;
    const TableReader phase = reader.table("phase", keys::phase());
    constexpr std::array<std::string_view, 2> kinds{"henyey_greenstein", "rayleigh"};
    if (phase.exactly_one(kinds) == "henyey_greenstein") {
        medium.asymmetry = phase.number("henyey_greenstein", {-1.0, 1.0, true, true});
        return;
    }
    if (!phase.flag("rayleigh"))
        phase.fail("rayleigh", fmt::format("rayleigh of {} is false. Say true, or leave phase away "
                                           "for isotropic scattering.",
                                           phase.thing()));
    medium.phase = radiosity::PhaseKind::rayleigh;
}

// The part that goes about the mirror direction.
void read_specular(const TableReader& reader, std::size_t bands, radiosity::Material& material) {
    if (!reader.has("specular")) {
        if (reader.has("roughness"))
            reader.fail("roughness", fmt::format("roughness of {} is that of its specular part, "
                                                 "which it has none of. Give specular as well.",
                                                 reader.thing()));
        return;
    }
    material.specular = reader.spectrum("specular", bands, fraction);
    material.roughness = reader.number("roughness", fraction, 0.0);
    for (std::size_t b = 0; b < bands; ++b)
        if (material.reflectance[b] + material.specular[b] > 1.0 + 1e-12)
            reader.fail("specular",
                        fmt::format("specular {} and reflectance {} of {} reflect more light than "
                                    "falls on it. Let them add up to 1 at most.",
                                    material.specular[b], material.reflectance[b], reader.thing()));
    if (reader.has("flux"))
        reader.fail("specular", fmt::format("specular of {} has no meaning beside flux, which "
                                            "gives back all light, evenly. Give one of the two.",
                                            reader.thing()));
}

// Absorption of the gases beside that of what extinction speaks of: soot, droplets.
void add_gases(const TableReader& reader, const radiosity::Scene& scene,
               radiosity::Medium& medium) {
    if (!reader.has("partial_pressure")) return;
    const auto& gases = scene.spectral.grey_gases.gases;
    if (gases.empty())
        reader.fail(
            "partial_pressure",
            fmt::format("partial_pressure of {} needs the gases' absorption. Give the scene "
                        "grey_gases = \"file.toml\", or give extinction.",
                        reader.thing()));
    if (!medium.shape.empty())
        reader.fail(
            "partial_pressure",
            fmt::format("partial_pressure of {} is the same everywhere, its extinction "
                        "varies in space. Give one of the two, or one number of extinction.",
                        reader.thing()));
    const double pressure = reader.number("partial_pressure", quantity);
    for (std::size_t b = 1; b < scene.bands; ++b) {
        const double scattering = medium.extinction[b] * medium.albedo[b];
        medium.extinction[b] += pressure * gases[b - 1].absorption;
        if (medium.extinction[b] > 0.0) medium.albedo[b] = scattering / medium.extinction[b];
    }
}

void read_medium_source(const TableReader& reader, const Heat& heat, radiosity::Medium& medium) {
    const std::size_t bands = heat.scene.bands;
    constexpr std::array<std::string_view, 3> sources{"emission", "temperature", "heat"};
    const auto source = reader.at_most_one(sources);
    if (source == "emission") {
        medium.emission = reader.spectrum("emission", bands, quantity);
    } else if (source == "temperature") {
        medium.emission = black_radiance(reader, heat);
    } else if (source == "heat") {
        medium.heat = read_total(reader, "heat", quantity, heat.scene);
        for (std::size_t band = 0; band < medium.heat.size(); ++band) {
            const auto& extinction = medium.extinction;
            const double able = medium.heat.size() == bands
                                    ? extinction[band]
                                    : *std::max_element(extinction.begin(), extinction.end());
            if (medium.heat[band] > 0.0 && able == 0.0) {
                reader.fail("heat",
                            fmt::format("heat {} of {} has nothing to emit it: its extinction is "
                                        "0. Give an extinction above 0.",
                                        medium.heat[band], reader.thing()));
            }
        }
    }
}

radiosity::Sun read_sun(const TableReader& reader, std::size_t bands) {
    return {.direction = read_direction(reader, "direction"),
            .irradiance = reader.spectrum("irradiance", bands, quantity),
            .angle = degree * reader.number("angle", {0.0, 90.0}, 0.0)};
}

radiosity::PointLight read_point(const TableReader& reader, std::size_t bands) {
    return {.position = reader.vector("position", coordinate),
            .intensity = reader.spectrum("intensity", bands, quantity)};
}

radiosity::SpotLight read_spot(const TableReader& reader, std::size_t bands) {
    radiosity::SpotLight spot;
    spot.position = reader.vector("position", coordinate);
    constexpr std::array<std::string_view, 2> aims{"direction", "target"};
    if (reader.exactly_one(aims) == "direction") {
        spot.direction = read_direction(reader, "direction");
    } else {
        const auto axis = reader.vector("target", coordinate) - spot.position;
        if (!(glm::length(axis) > 0.0)) {
            reader.fail("target", fmt::format("target of {} is its position. Move one of them.",
                                              reader.thing()));
        }
        spot.direction = glm::normalize(axis);
    }
    spot.intensity = reader.spectrum("intensity", bands, quantity);
    const double angle = reader.number("angle", {0.0, 180.0, true});
    const double soft_edge = reader.number("soft_edge", {0.0, 90.0}, 0.0);
    if (angle / 2 + soft_edge > 180.0) {  // cannot be, with the ranges above: kept beside them
        reader.fail("soft_edge",
                    fmt::format("soft_edge {} of {} reaches round to the axis. Give less.",
                                soft_edge, reader.thing()));
    }
    spot.angle = degree * angle;
    spot.soft_edge = degree * soft_edge;
    return spot;
}

}  // namespace

glm::dvec3 read_direction(const TableReader& reader, std::string_view key) {
    const glm::dvec3 vector = reader.vector(key, coordinate);
    const double length = glm::length(vector);
    if (!(length > 1e-100)) {
        reader.fail(key, fmt::format("{} of {} is [0, 0, 0]. Give a direction of any length but 0.",
                                     key, reader.thing()));
    }
    return vector / length;
}

void read_materials(const TableReader& root, Names& names, radiosity::Scene& scene,
                    std::vector<std::string>& notes) {
    const auto tables = root.tables("material");
    std::vector<TableReader> readers;
    for (const toml::table* table : tables) {
        radiosity::Material material;
        material.name = names.take(*table);
        const TableReader reader(*table, keys::material(), named("material", material.name));
        material.where = reader.where();
        material.reflectance = reader.spectrum("reflectance", scene.bands, fraction);
        if (!scene.spectral.grey_gases.gases.empty() && reader.node("reflectance").is_array())
            reader.fail(
                "reflectance",
                fmt::format("reflectance of {} is to hold for all wavelengths, as the bands "
                            "are grey gases, which mix them. Give one number.",
                            reader.thing()));
        read_specular(reader, scene.bands, material);
        read_emission(reader, {scene, notes}, material);
        scene.materials.push_back(std::move(material));
        readers.push_back(reader);
    }
    for (std::size_t i = 0; i < readers.size(); ++i) {
        if (readers[i].has("back")) scene.materials[i].back = names.find(readers[i], "back");
    }
    for (std::size_t i = 0; i < readers.size(); ++i) check_back(readers[i], scene.materials, i);
}

void read_media(const TableReader& root, const std::filesystem::path& folder,
                radiosity::Scene& scene, std::vector<std::string>& notes) {
    Names names("medium");
    const toml::table* everywhere = nullptr;
    std::string name_of_everywhere;
    for (const toml::table* table : root.tables("medium")) {
        radiosity::Medium medium;
        medium.name = names.take(*table);
        const TableReader reader(*table, keys::medium(), named("medium", medium.name));
        medium.where = reader.where();
        if (reader.has("extinction") || !reader.has("partial_pressure"))
            read_extinction(reader, folder, scene.bands, medium);
        else
            medium.extinction.assign(scene.bands, 0.0);
        medium.albedo = reader.has("albedo") ? reader.spectrum("albedo", scene.bands, fraction)
                                             : Spectrum(scene.bands, 0.0);
        read_phase(reader, medium);
        add_gases(reader, scene, medium);
        read_medium_source(reader, {scene, notes}, medium);

        constexpr std::array<std::string_view, 2> places{"fills", "at"};
        const auto place = reader.at_most_one(places);
        constexpr std::array<std::string_view, 1> fills{"everywhere"};
        if (place == "fills") reader.choice("fills", fills);
        if (place == "at") {
            medium.at = reader.vector("at", coordinate);
        } else if (everywhere) {
            reader.fail(
                "fills",
                fmt::format("{} and medium \"{}\" ({}) both fill everywhere. Give one of "
                            "them a point, at = [x, y, z], in the region it fills.",
                            reader.thing(), name_of_everywhere, place_of(everywhere->source())));
        } else {
            everywhere = table;
            name_of_everywhere = medium.name;
        }
        scene.media.push_back(std::move(medium));
    }
}

void read_lights(const TableReader& root, radiosity::Scene& scene) {
    Names names("light");
    for (const toml::table* table : root.tables("light")) {
        radiosity::Light light;
        light.name = names.take(*table);
        const TableReader reader(*table, keys::light(), named("light", light.name));
        light.where = reader.where();
        constexpr std::array<std::string_view, 3> kinds{"sun", "point", "spot"};
        const std::string_view kind = reader.exactly_one(kinds);
        if (kind == "sun") light.source = read_sun(reader.table("sun", keys::sun()), scene.bands);
        if (kind == "point") {
            light.source = read_point(reader.table("point", keys::point()), scene.bands);
        }
        if (kind == "spot")
            light.source = read_spot(reader.table("spot", keys::spot()), scene.bands);
        scene.lights.push_back(std::move(light));
    }
}

void read_environment(const TableReader& root, radiosity::Scene& scene) {
    scene.environment = Spectrum(scene.bands, 0.0);
    if (!root.has("environment")) return;
    const TableReader reader = root.table("environment", keys::environment(), "[environment]");
    if (reader.has("radiance")) {
        scene.environment = reader.spectrum("radiance", scene.bands, quantity);
    }
}

}  // namespace tyndall::cli
