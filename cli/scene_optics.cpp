#include "cli/scene_optics.h"

#include <fmt/format.h>

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

constexpr double stefan_boltzmann = 5.670374419e-8;  // [W/m²/K⁴]
constexpr Range kelvin{0.0, 1e6};
constexpr double degree = pi / 180.0;  // [rad]

std::string named(std::string_view kind, const std::string& name) {
    return fmt::format("{} \"{}\"", kind, name);
}

// σT⁴/π [W/m²/sr], one band.
double black_radiance(const TableReader& reader, std::size_t bands) {
    if (bands != 1) {
        reader.fail(
            "temperature",
            fmt::format("temperature of {} needs one band, the scene has {}. Give emission, one "
                        "value a band.",
                        reader.thing(), bands));
    }
    const double kelvins = reader.number("temperature", kelvin);
    return stefan_boltzmann * std::pow(kelvins, 4) / pi;
}

void read_emission(const TableReader& reader, std::size_t bands, radiosity::Material& material) {
    constexpr std::array<std::string_view, 4> sources{"emission", "exitance", "power",
                                                      "temperature"};
    const auto source = reader.at_most_one(sources);
    if (source == "emission") {
        material.emission = reader.spectrum("emission", bands, quantity);
    } else if (source == "exitance") {
        material.emission = reader.spectrum("exitance", bands, quantity);
        for (double& value : material.emission) value /= pi;
    } else if (source == "power") {
        material.power = reader.spectrum("power", bands, quantity);
    } else if (source == "temperature") {
        const double radiance = black_radiance(reader, bands);
        material.emission = {(1.0 - material.reflectance[0]) * radiance};
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

std::optional<double> read_phase(const TableReader& reader) {
    if (!reader.has("phase")) return std::nullopt;
    return reader.table("phase", keys::phase())
        .number("henyey_greenstein", {-1.0, 1.0, true, true});
}

void read_medium_source(const TableReader& reader, std::size_t bands, radiosity::Medium& medium) {
    constexpr std::array<std::string_view, 3> sources{"emission", "temperature", "heat"};
    const auto source = reader.at_most_one(sources);
    if (source == "emission") {
        medium.emission = reader.spectrum("emission", bands, quantity);
    } else if (source == "temperature") {
        medium.emission = {black_radiance(reader, bands)};
    } else if (source == "heat") {
        medium.heat = reader.spectrum("heat", bands, quantity);
        for (std::size_t band = 0; band < bands; ++band) {
            if (medium.heat[band] > 0.0 && medium.extinction[band] == 0.0) {
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

void read_materials(const TableReader& root, Names& names, radiosity::Scene& scene) {
    const auto tables = root.tables("material");
    std::vector<TableReader> readers;
    for (const toml::table* table : tables) {
        radiosity::Material material;
        material.name = names.take(*table);
        const TableReader reader(*table, keys::material(), named("material", material.name));
        material.where = reader.where();
        material.reflectance = reader.spectrum("reflectance", scene.bands, fraction);
        read_emission(reader, scene.bands, material);
        scene.materials.push_back(std::move(material));
        readers.push_back(reader);
    }
    for (std::size_t i = 0; i < readers.size(); ++i) {
        if (readers[i].has("back")) scene.materials[i].back = names.find(readers[i], "back");
    }
    for (std::size_t i = 0; i < readers.size(); ++i) check_back(readers[i], scene.materials, i);
}

void read_media(const TableReader& root, const std::filesystem::path& folder,
                radiosity::Scene& scene) {
    Names names("medium");
    const toml::table* everywhere = nullptr;
    std::string name_of_everywhere;
    for (const toml::table* table : root.tables("medium")) {
        radiosity::Medium medium;
        medium.name = names.take(*table);
        const TableReader reader(*table, keys::medium(), named("medium", medium.name));
        medium.where = reader.where();
        read_extinction(reader, folder, scene.bands, medium);
        medium.albedo = reader.has("albedo") ? reader.spectrum("albedo", scene.bands, fraction)
                                             : Spectrum(scene.bands, 0.0);
        medium.asymmetry = read_phase(reader).value_or(0.0);
        read_medium_source(reader, scene.bands, medium);

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
