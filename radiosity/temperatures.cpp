#include "radiosity/temperatures.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numbers>

namespace tyndall::radiosity {
namespace {

using std::numbers::pi;

// Of a leaf, one value a band.
template <class Node>
Spectrum emission_in(const Solution& s, Node node) {
    Spectrum emission(s.enclosure->bands);
    for (std::size_t b = 0; b < emission.size(); ++b) emission[b] = emission_of(s, node, b);
    return emission;
}

template <class Node>
Spectrum incident_at(const Solution& s, Node node, Point x) {
    Spectrum incident(s.enclosure->bands);
    for (std::size_t b = 0; b < incident.size(); ++b)
        incident[b] = std::max(0.0, s.direct.at(node, b).at(x) + s.indirect.at(node, b).at(x));
    return incident;
}

// Of linear parts: in the centroid they have the mean.
template <class Node>
Spectrum mean_incident(const Solution& s, Node node) {
    const Point x = s.forest.centroid(node);
    Spectrum incident(s.enclosure->bands);
    for (std::size_t b = 0; b < incident.size(); ++b)
        incident[b] = std::max(
            0.0, s.direct.at(node, b).Affine::at(x) + s.indirect.at(node, b).Affine::at(x));
    return incident;
}

// R of (44).
double taken_up(double source, const Spectrum& absorbs, std::span<const double> incident) {
    for (std::size_t b = 0; b < absorbs.size(); ++b) source += absorbs[b] * incident[b];
    return source;
}

// The mean being taken, and what it is divided by.
struct TemperatureSums {
    TemperatureRange range{0.0, std::numeric_limits<double>::infinity(), 0.0};
    double measure = 0.0;

    void add(double temperature, double size) {
        range.mean += size * temperature;
        measure += size;
        range.lowest = std::min(range.lowest, temperature);
        range.highest = std::max(range.highest, temperature);
    }
};

bool emits(const Spectrum& weights) {
    return std::ranges::any_of(weights, [](double w) { return w > 0.0; });
}

}  // namespace

double temperature_of(const SpectralModel& model, const SurfaceSide& side,
                      std::span<const double> emission, std::span<const double> incident) {
    Spectrum emissivity = side.emissivity;
    if (emissivity.empty())
        for (const double rho : side.reflectance) emissivity.push_back(1.0 - rho);
    double total = 0.0;
    for (std::size_t b = 0; b < emissivity.size(); ++b)
        total += emission[b] + (side.reflectance[b] - (1.0 - emissivity[b])) * incident[b];
    return temperature_of(model, emissivity, total);
}

double temperature_of(const SpectralModel& model, const MediumOptics& medium,
                      std::span<const double> emission, std::span<const double> incident) {
    double total = 0.0;
    for (std::size_t b = 0; b < medium.absorption.size(); ++b) {
        const double scattering = medium.extinction[b] - medium.absorption[b];
        total += medium.extinction[b] * emission[b] +
                 (medium.albedo[b] * medium.extinction[b] - scattering) * incident[b];
    }
    return temperature_of(model, medium.absorption, total);
}

double temperature_there(const SpectralModel& model, const SurfaceSide& side,
                         std::span<const double> emission, std::span<const double> incident) {
    if (!side.settled_flux) return temperature_of(model, side, emission, incident);
    return temperature_of(model, side.emissivity,
                          taken_up(*side.settled_flux / pi, side.emissivity, incident));
}

double temperature_there(const SpectralModel& model, const MediumOptics& medium,
                         std::span<const double> emission, std::span<const double> incident) {
    if (!medium.settled_heat) return temperature_of(model, medium, emission, incident);
    return temperature_of(model, medium.absorption,
                          taken_up(*medium.settled_heat / (4.0 * pi), medium.absorption, incident));
}

double temperature_of(const Solution& s, PatchId patch) {
    const auto of = side_of(*s.enclosure, s.forest, patch);
    if (of == none) return std::numeric_limits<double>::quiet_NaN();
    return temperature_of(s.enclosure->spectral, s.enclosure->sides[of], emission_in(s, patch),
                          mean_incident(s, patch));
}

double temperature_of(const Solution& s, ZoneId zone) {
    const auto of = medium_of(*s.enclosure, s.forest, zone);
    if (of == none) return std::numeric_limits<double>::quiet_NaN();
    return temperature_of(s.enclosure->spectral, s.enclosure->media[of], emission_in(s, zone),
                          mean_incident(s, zone));
}

double temperature_at(const Solution& s, PatchId patch, Point x) {
    const auto of = side_of(*s.enclosure, s.forest, patch);
    if (of == none) return std::numeric_limits<double>::quiet_NaN();
    return temperature_there(s.enclosure->spectral, s.enclosure->sides[of], emission_in(s, patch),
                             incident_at(s, patch, x));
}

double temperature_at(const Solution& s, ZoneId zone, Point x) {
    const auto of = medium_of(*s.enclosure, s.forest, zone);
    if (of == none) return std::numeric_limits<double>::quiet_NaN();
    return temperature_there(s.enclosure->spectral, s.enclosure->media[of], emission_in(s, zone),
                             incident_at(s, zone, x));
}

void report_temperatures(Solution& s) {
    const Enclosure& e = *s.enclosure;
    if (!e.thermal) return;
    std::map<std::string, TemperatureSums> sums;
    std::map<std::string, std::size_t> without;
    const auto add = [&](const std::string& name, double temperature, double size) {
        if (temperature >= 0.0)
            sums[name].add(temperature, size);
        else
            ++without[name];
    };
    const Elements leaves = elements_of_leaves(e, s.forest);
    for (const PatchId patch : leaves.patches) {
        const SurfaceSide& side = e.sides[side_of(e, s.forest, patch)];
        if (side.emissivity.empty() || emits(side.emissivity))
            add(side.name, temperature_of(s, patch), s.forest.area(patch));
    }
    for (const ZoneId zone : leaves.zones) {
        const MediumOptics& medium = e.media[medium_of(e, s.forest, zone)];
        if (emits(medium.absorption))
            add(medium.name, temperature_of(s, zone), s.forest.volume(zone));
    }
    for (auto& [name, sum] : sums) {
        sum.range.mean /= sum.measure;
        s.report.temperature[name] = sum.range;
    }
    for (const auto& [name, leaves] : without)
        s.report.warnings.push_back(fmt::format(
            "\"{}\" is to take up more heat than arrives there: {} of its elements have no "
            "temperature. Ask for a smaller sink.",
            name, leaves));
}

}  // namespace tyndall::radiosity
