// /tyndall/enclosure: optics and lights as JSON, extinction that varies as arrays.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "mesh/input_error.h"
#include "radiosity/solution_parts.h"

namespace tyndall::radiosity {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const glm::dvec3& v) {
    return Json::array({v.x, v.y, v.z});
}

glm::dvec3 vector_of(const Json& json) {
    return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

Json light_json(const Light& light) {
    Json json{{"name", light.name}, {"where", light.where}};
    if (const auto* sun = std::get_if<Sun>(&light.source))
        json["sun"] = {{"direction", vector_json(sun->direction)},
                       {"irradiance", sun->irradiance},
                       {"angle", sun->angle}};
    else if (const auto* point = std::get_if<PointLight>(&light.source))
        json["point"] = {{"position", vector_json(point->position)},
                         {"intensity", point->intensity}};
    else if (const auto* spot = std::get_if<SpotLight>(&light.source))
        json["spot"] = {{"position", vector_json(spot->position)},
                        {"direction", vector_json(spot->direction)},
                        {"intensity", spot->intensity},
                        {"angle", spot->angle},
                        {"soft_edge", spot->soft_edge}};
    return json;
}

Light light_of(const Json& json) {
    Light light{json.at("name").get<std::string>(), Sun{}, json.at("where").get<std::string>()};
    if (json.contains("sun")) {
        const Json& sun = json["sun"];
        light.source = Sun{vector_of(sun.at("direction")), sun.at("irradiance").get<Spectrum>(),
                           sun.at("angle").get<double>()};
    } else if (json.contains("point")) {
        const Json& point = json["point"];
        light.source =
            PointLight{vector_of(point.at("position")), point.at("intensity").get<Spectrum>()};
    } else {
        const Json& spot = json.at("spot");
        light.source =
            SpotLight{vector_of(spot.at("position")), vector_of(spot.at("direction")),
                      spot.at("intensity").get<Spectrum>(), spot.at("angle").get<double>(),
                      spot.at("soft_edge").get<double>()};
    }
    return light;
}

Json spectral_json(const SpectralModel& model) {
    Json json{{"band_edges", model.band_edges}};  // infinity is written as null
    const GreyGases& grey = model.grey_gases;
    json["name"] = grey.name;
    json["temperatures"] = {grey.lowest, grey.highest};
    json["gases"] = Json::array();
    for (const GreyGas& gas : grey.gases)
        json["gases"].push_back({{"absorption", gas.absorption}, {"weights", gas.weights}});
    return json;
}

SpectralModel spectral_of(const Json& json) {
    SpectralModel model;
    for (const auto& edge : json.at("band_edges"))
        model.band_edges.push_back(edge.is_null() ? HUGE_VAL : edge.get<double>());
    model.grey_gases = {json.at("name").get<std::string>(),
                        json.at("temperatures").at(0).get<double>(),
                        json.at("temperatures").at(1).get<double>(),
                        {}};
    for (const auto& gas : json.at("gases"))
        model.grey_gases.gases.push_back(
            {gas.at("absorption").get<double>(), gas.at("weights").get<std::vector<double>>()});
    return model;
}

// A number that may be missing.
Json optional_json(const std::optional<double>& value) {
    return value ? Json(*value) : Json();
}

std::optional<double> optional_of(const Json& json, const char* key) {
    const auto found = json.find(key);
    if (found == json.end() || found->is_null()) return {};
    return found->get<double>();
}

Json side_json(const SurfaceSide& side) {
    return {{"name", side.name},
            {"surface", side.surface},
            {"back", side.side == Side::back},
            {"reflectance", side.reflectance},
            {"emission", side.emission},
            {"area", side.area},
            {"emissivity", side.emissivity},
            {"settled_flux", optional_json(side.settled_flux)},
            {"specular", side.specular},
            {"roughness", side.roughness},
            {"mirror", side.mirror}};
}

// Files of earlier versions have no emissivity, nor what comes after it.
SurfaceSide side_from(const Json& json) {
    return {json.at("name").get<std::string>(),
            json.at("surface").get<std::size_t>(),
            json.at("back").get<bool>() ? Side::back : Side::front,
            json.at("reflectance").get<Spectrum>(),
            json.at("emission").get<Spectrum>(),
            json.at("area").get<double>(),
            json.value("emissivity", Spectrum()),
            optional_of(json, "settled_flux"),
            json.value("specular", Spectrum()),
            json.value("roughness", 0.0),
            json.value("mirror", Spectrum())};
}

Json medium_json(const MediumOptics& medium) {
    return {{"name", medium.name},
            {"extinction", medium.extinction},
            {"albedo", medium.albedo},
            {"emission", medium.emission},
            {"absorption", medium.absorption},
            {"settled_heat", optional_json(medium.settled_heat)},
            {"scattering", medium.scattering},
            {"rayleigh", medium.phase.kind == PhaseKind::rayleigh},
            {"asymmetry", medium.phase.asymmetry}};
}

MediumOptics medium_from(const Json& json) {
    return {json.at("name").get<std::string>(),
            json.at("extinction").get<Spectrum>(),
            json.at("albedo").get<Spectrum>(),
            json.at("emission").get<Spectrum>(),
            json.at("absorption").get<Spectrum>(),
            optional_of(json, "settled_heat"),
            {},
            json.value("scattering", Spectrum()),
            {json.value("rayleigh", false) ? PhaseKind::rayleigh : PhaseKind::henyey_greenstein,
             json.value("asymmetry", 0.0)}};
}

Json optics_json(const Enclosure& e) {
    Json json;
    json["bands"] = e.bands;
    json["open"] = e.open;
    json["region_count"] = e.mesh.region_count;
    json["hull_min"] = vector_json(e.mesh.hull_min);
    json["hull_max"] = vector_json(e.mesh.hull_max);
    json["environment"] = e.environment;
    json["sides"] = Json::array();
    for (const auto& side : e.sides) json["sides"].push_back(side_json(side));
    json["media"] = Json::array();
    for (const auto& medium : e.media) json["media"].push_back(medium_json(medium));
    json["lights"] = Json::array();
    for (const auto& light : e.lights) json["lights"].push_back(light_json(light));
    json["warnings"] = e.warnings;
    json["spectral"] = spectral_json(e.spectral);
    json["thermal"] = e.thermal;
    return json;
}

void bind_optics(const Json& json, Enclosure& e) {
    e.bands = json.at("bands").get<std::size_t>();
    e.open = json.at("open").get<bool>();
    e.mesh.region_count = json.at("region_count").get<std::size_t>();
    e.mesh.hull_min = vector_of(json.at("hull_min"));
    e.mesh.hull_max = vector_of(json.at("hull_max"));
    e.environment = json.at("environment").get<Spectrum>();
    for (const auto& side : json.at("sides")) e.sides.push_back(side_from(side));
    for (const auto& medium : json.at("media")) e.media.push_back(medium_from(medium));
    if (json.contains("spectral")) e.spectral = spectral_of(json.at("spectral"));
    e.thermal = json.value("thermal", false);
    for (const auto& light : json.at("lights")) e.lights.push_back(light_of(light));
    e.warnings = json.at("warnings").get<std::vector<std::string>>();
}

// Every spectrum has a value a band.
bool spectra_fit(const Enclosure& e) {
    const auto fits = [&](const Spectrum& s) { return s.size() == e.bands; };
    bool good = e.bands >= 1 && fits(e.environment);
    const SpectralModel& model = e.spectral;
    if (!model.band_edges.empty()) good = good && model.band_edges.size() == e.bands + 1;
    if (!model.grey_gases.gases.empty()) good = good && model.grey_gases.bands() == e.bands;
    for (const auto& side : e.sides)
        good = good && fits(side.reflectance) && fits(side.emission) &&
               (side.emissivity.empty() || fits(side.emissivity)) &&
               (side.specular.empty() || fits(side.specular)) &&
               (side.mirror.empty() || fits(side.mirror));
    for (const auto& m : e.media)
        good = good && fits(m.extinction) && fits(m.albedo) && fits(m.emission) &&
               fits(m.absorption) && (m.scattering.empty() || fits(m.scattering));
    for (const auto& light : e.lights)
        good = good && std::visit(
                           [&](const auto& source) {
                               if constexpr (requires { source.irradiance; })
                                   return fits(source.irradiance);
                               else
                                   return fits(source.intensity);
                           },
                           light.source);
    return good;
}

// Extinction that varies: the grids of all media in one list, as arrays, and which of them each
// band of a medium has.
void write_grids(Hdf5Writer& file, const Enclosure& e) {
    std::vector<const RegularGrid*> grids;
    Json json = Json::array();
    for (const auto& medium : e.media) {
        json.push_back(Json::array());
        for (const ExtinctionBand& band : medium.varying) {
            auto at = std::find(grids.begin(), grids.end(), band.shape.get());
            if (at == grids.end()) at = grids.insert(at, band.shape.get());
            json.back().push_back({{"grid", at - grids.begin()}, {"factor", band.factor}});
        }
    }
    Json boxes = Json::array();
    for (std::size_t g = 0; g < grids.size(); ++g) {
        boxes.push_back({{"counts", grids[g]->counts()},
                         {"low", vector_json(grids[g]->low())},
                         {"high", vector_json(grids[g]->high())},
                         {"beyond_is_edge", grids[g]->beyond() == BeyondGrid::edge}});
        file.array(fmt::format("{}/extinction_{}", enclosure_path, g), grids[g]->values());
    }
    file.text(enclosure_path + "/extinction", Json{{"media", json}, {"grids", boxes}}.dump());
}

std::shared_ptr<const RegularGrid> read_grid(const Hdf5Reader& file, const Json& box,
                                             std::size_t index) {
    auto values = file.array<float>(fmt::format("{}/extinction_{}", enclosure_path, index));
    try {
        return std::make_shared<const RegularGrid>(
            box.at("counts").get<std::array<std::size_t, 3>>(), vector_of(box.at("low")),
            vector_of(box.at("high")), std::move(values),
            box.at("beyond_is_edge").get<bool>() ? BeyondGrid::edge : BeyondGrid::nothing);
    } catch (const mesh::InputError& error) {
        file.fail(
            fmt::format("'{}/extinction_{}' is damaged ({})", enclosure_path, index, error.what()));
    }
}

void read_grids(const Hdf5Reader& file, Enclosure& e) {
    const std::string path = enclosure_path + "/extinction";
    if (!file.has(path)) return;  // it is uniform everywhere
    try {
        const Json json = Json::parse(file.text(path));
        std::vector<std::shared_ptr<const RegularGrid>> grids;
        for (const Json& box : json.at("grids"))
            grids.push_back(read_grid(file, box, grids.size()));
        const Json& media = json.at("media");
        for (std::size_t m = 0; m < e.media.size(); ++m) {
            auto& varying = e.media[m].varying;
            for (const Json& band : media.at(m))
                varying.push_back({grids.at(band.at("grid").get<std::size_t>()),
                                   band.at("factor").get<double>()});
            if (!varying.empty() && varying.size() != e.bands)
                file.fail(fmt::format("'{}' has other counts of bands", path));
        }
    } catch (const Json::exception& error) {
        file.fail(fmt::format("'{}' is damaged ({})", path, error.what()));
    } catch (const std::out_of_range&) {
        file.fail(fmt::format("'{}' points beyond its table", path));
    }
}

}  // namespace

void write_optics(Hdf5Writer& file, const Enclosure& e) {
    file.text(enclosure_path + "/optics",
              optics_json(e).dump(1, ' ', false, Json::error_handler_t::replace));
    if (e.varies()) write_grids(file, e);
}

void read_optics(const Hdf5Reader& file, Enclosure& e) {
    const std::string path = enclosure_path + "/optics";
    try {
        bind_optics(Json::parse(file.text(path)), e);
    } catch (const Json::exception& error) {
        file.fail(fmt::format("'{}' is damaged ({})", path, error.what()));
    }
    if (!spectra_fit(e)) file.fail(fmt::format("'{}' has other counts of bands", path));
    read_grids(file, e);
}

}  // namespace tyndall::radiosity
