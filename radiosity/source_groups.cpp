#include "radiosity/source_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tyndall::radiosity {
namespace {

struct Source {
    std::string name;
    Spectrum* values;
};

// All that gives light, in one order for all scenes.
std::vector<Source> sources_of(Scene& scene) {
    std::vector<Source> sources;
    const auto add = [&](const std::string& name, Spectrum& values) {
        if (!values.empty()) sources.push_back({name, &values});
    };
    for (Material& material : scene.materials) {
        const std::string name = fmt::format("material \"{}\"", material.name);
        add(name, material.emission);
        add(name, material.power);
    }
    for (Medium& medium : scene.media) {
        const std::string name = fmt::format("medium \"{}\"", medium.name);
        add(name, medium.emission);
        add(name, medium.heat);
    }
    for (Light& light : scene.lights) {
        const std::string name = fmt::format("light \"{}\"", light.name);
        if (auto* sun = std::get_if<Sun>(&light.source)) add(name, sun->irradiance);
        if (auto* point = std::get_if<PointLight>(&light.source)) add(name, point->intensity);
        if (auto* spot = std::get_if<SpotLight>(&light.source)) add(name, spot->intensity);
    }
    add("environment", scene.environment);
    return sources;
}

// Two sources in step may differ by roundings of what they were interpolated from.
bool in_step(const std::vector<Spectrum>& a, const std::vector<Spectrum>& b) {
    constexpr double rounding = 1e-12;
    for (std::size_t s = 0; s < a.size(); ++s)
        for (std::size_t band = 0; band < a[s].size(); ++band)
            if (std::abs(a[s][band] - b[s][band]) > rounding) return false;
    return true;
}

// Shares of the largest; 1 in a band that is dark in all scenes, so that it parts no group.
std::vector<Spectrum> weights_of(const std::vector<Spectrum>& values, const Spectrum& largest) {
    std::vector<Spectrum> weights = values;
    for (Spectrum& of_scene : weights)
        for (std::size_t b = 0; b < of_scene.size(); ++b)
            of_scene[b] = largest[b] > 0.0 ? of_scene[b] / largest[b] : 1.0;
    return weights;
}

bool dark(const Spectrum& values) {
    return std::all_of(values.begin(), values.end(), [](double v) { return v == 0.0; });
}

}  // namespace

SourceGroups group_sources(std::span<const Scene> scenes) {
    SourceGroups result{scenes.front(), {}};
    const auto largest = sources_of(result.largest);
    const std::size_t count = largest.size();
    std::vector<std::vector<Spectrum>> values(count);  // of each source and scene
    for (Scene scene : scenes) {
        const auto sources = sources_of(scene);
        for (std::size_t k = 0; k < count; ++k) {
            values[k].push_back(*sources[k].values);
            for (std::size_t b = 0; b < scene.bands; ++b) {
                double& most = (*largest[k].values)[b];
                most = std::max(most, values[k].back()[b]);
            }
        }
    }
    Scene all_dark = result.largest;
    for (const Source& source : sources_of(all_dark)) source.values->assign(all_dark.bands, 0.0);
    for (std::size_t k = 0; k < count; ++k) {
        if (dark(*largest[k].values)) continue;
        auto weights = weights_of(values[k], *largest[k].values);
        auto group = std::find_if(result.groups.begin(), result.groups.end(),
                                  [&](const auto& g) { return in_step(g.weights, weights); });
        if (group == result.groups.end())
            group = result.groups.insert(group, {{}, all_dark, std::move(weights)});
        group->sources.push_back(largest[k].name);
        *sources_of(group->scene)[k].values = *largest[k].values;
    }
    return result;
}

}  // namespace tyndall::radiosity
