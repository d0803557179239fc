#include "render/element_fields.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "mesh/input_error.h"
#include "radiosity/temperatures.h"

namespace tyndall::render {
namespace {

using mesh::PatchId;
using mesh::Point;
using mesh::ZoneId;
using radiosity::Solution;

template <class Value>
double mean_over_bands(const Solution& s, Value&& value) {
    double sum = 0.0;
    for (std::size_t b = 0; b < s.enclosure->bands; ++b) sum += value(b);
    return sum / static_cast<double>(s.enclosure->bands);
}

template <class Id>
double radiance(const Solution& s, Id id, Point x) {
    return mean_over_bands(s, [&](std::size_t b) {
        return radiosity::emission_of(s, id, b) +
               radiosity::scatter_of(s, id, b) *
                   (s.direct.at(id, b).at(x) + s.indirect.at(id, b).at(x));
    });
}

template <class Id>
double direct(const Solution& s, Id id, Point x) {
    return mean_over_bands(s, [&](std::size_t b) { return s.direct.at(id, b).at(x); });
}

template <class Id>
double indirect(const Solution& s, Id id, Point x) {
    return mean_over_bands(s, [&](std::size_t b) { return s.indirect.at(id, b).at(x); });
}

template <class Id>
double incident(const Solution& s, Id id, Point x) {
    return direct(s, id, x) + indirect(s, id, x);
}

template <class Id>
double temperature(const Solution& s, Id id, Point x) {
    return s.enclosure->thermal ? radiosity::temperature_at(s, id, x)
                                : std::numeric_limits<double>::quiet_NaN();
}

double error_of_zone(const Solution& s, ZoneId id, Point) {
    return s.zone_error[id.value];
}

double error_of_patch(const Solution& s, PatchId id, Point) {
    return s.patch_error[id.value];
}

template <class Id>
double level(const Solution& s, Id id, Point) {
    return s.forest[id].level;
}

// Ω of zones, ρ of patches.
template <class Id>
double albedo(const Solution& s, Id id, Point) {
    return mean_over_bands(s, [&](std::size_t b) { return radiosity::scatter_of(s, id, b); });
}

double extinction_of_zone(const Solution& s, ZoneId id, Point x) {
    const auto medium = radiosity::medium_of(*s.enclosure, s.forest, id);
    if (medium == radiosity::none) return 0.0;
    const auto& optics = s.enclosure->media[medium];
    return mean_over_bands(s, [&](std::size_t b) {
        return optics.varying.empty() ? optics.extinction[b] : optics.varying[b].at(x);
    });
}

double no_extinction(const Solution&, PatchId, Point) {
    return 0.0;
}

constexpr NamedField fields[] = {
    {"radiance", "W/m2/sr", true, radiance<ZoneId>, radiance<PatchId>},
    {"direct", "W/m2/sr", true, direct<ZoneId>, direct<PatchId>},
    {"indirect", "W/m2/sr", true, indirect<ZoneId>, indirect<PatchId>},
    {"incident", "W/m2/sr", true, incident<ZoneId>, incident<PatchId>},
    {"temperature", "K", false, temperature<ZoneId>, temperature<PatchId>},
    {"error", "W/m2/sr", true, error_of_zone, error_of_patch},
    {"level", "bisections", false, level<ZoneId>, level<PatchId>},
    {"extinction", "1/m", false, extinction_of_zone, no_extinction},
    {"albedo", "1", false, albedo<ZoneId>, albedo<PatchId>},
};

}  // namespace

std::span<const NamedField> element_fields() {
    return fields;
}

std::vector<std::string_view> field_names() {
    std::vector<std::string_view> names;
    for (const NamedField& field : fields) names.push_back(field.name);
    return names;
}

const NamedField& field_named(std::string_view name) {
    for (const NamedField& field : fields)
        if (field.name == name) return field;
    throw mesh::InputError(fmt::format("elements have no field \"{}\". There are {}.", name,
                                       fmt::join(field_names(), ", ")));
}

}  // namespace tyndall::render
