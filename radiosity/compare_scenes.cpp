#include "radiosity/compare_scenes.h"

#include <fmt/format.h>

#include <algorithm>

namespace tyndall::radiosity {
namespace {

// Collects differences; the worst of them is the change.
class Differences {
  public:
    template <class T>
    void compare(const T& before, const T& after, SceneChange change, const std::string& what) {
        if (!(before == after)) add(change, what);
    }
    // Values that are there in both or in neither: how bright a source is.
    void compare_source(const Spectrum& before, const Spectrum& after, const std::string& what) {
        if (before == after) return;
        const bool both = before.size() == after.size();
        add(both ? SceneChange::emission : SceneChange::optics, what);
    }
    void add(SceneChange change, const std::string& what) {
        result_.change = std::max(result_.change, change);
        result_.what.push_back(what);
    }
    SceneDifference result() && { return std::move(result_); }

  private:
    SceneDifference result_;
};

void compare_materials(const Scene& before, const Scene& after, Differences& differences) {
    for (std::size_t m = 0; m < after.materials.size(); ++m) {
        const Material &a = before.materials[m], &b = after.materials[m];
        const std::string of = fmt::format(" of material \"{}\"", b.name);
        differences.compare(a.reflectance, b.reflectance, SceneChange::optics, "reflectance" + of);
        differences.compare(a.specular, b.specular, SceneChange::optics, "specular" + of);
        differences.compare(a.roughness, b.roughness, SceneChange::optics, "roughness" + of);
        differences.compare_source(a.emission, b.emission, "emission" + of);
        differences.compare_source(a.power, b.power, "power" + of);
        differences.compare(a.flux, b.flux, SceneChange::optics, "flux" + of);
        differences.compare(a.emits, b.emits, SceneChange::lights, "emitting sides" + of);
        differences.compare(a.back, b.back, SceneChange::geometry, "back" + of);
    }
}

bool same_shapes(const std::vector<ExtinctionShape>& a, const std::vector<ExtinctionShape>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const ExtinctionShape& p, const ExtinctionShape& q) {
                          return !p.where.empty() && p.where == q.where;
                      });
}

bool same_bands(const SpectralModel& a, const SpectralModel& b) {
    const GreyGases &first = a.grey_gases, &second = b.grey_gases;
    return a.band_edges == b.band_edges && first.lowest == second.lowest &&
           first.highest == second.highest &&
           std::equal(first.gases.begin(), first.gases.end(), second.gases.begin(),
                      second.gases.end(), [](const GreyGas& p, const GreyGas& q) {
                          return p.absorption == q.absorption && p.weights == q.weights;
                      });
}

// Whether light alone says nothing of what is sent out: temperatures do.
bool finds_temperatures(const Scene& scene) {
    const auto given = [](const auto& all, auto member) {
        return std::any_of(all.begin(), all.end(),
                           [&](const auto& one) { return !(one.*member).empty(); });
    };
    return scene.thermal || given(scene.materials, &Material::flux) ||
           given(scene.media, &Medium::heat);
}

bool same_polygons(const std::vector<mesh::Polygon>& a, const std::vector<mesh::Polygon>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const mesh::Polygon& p, const mesh::Polygon& q) {
                          return p.corners == q.corners && p.opacity == q.opacity;
                      });
}

void compare_surfaces(const Scene& before, const Scene& after, Differences& differences) {
    for (std::size_t s = 0; s < after.surfaces.size(); ++s) {
        const Surface &a = before.surfaces[s], &b = after.surfaces[s];
        const std::string of = fmt::format(" of surface \"{}\"", b.name);
        differences.compare(a.name, b.name, SceneChange::geometry, "name" + of);
        differences.compare(a.material, b.material, SceneChange::geometry, "material" + of);
        if (!same_polygons(a.polygons, b.polygons))
            differences.add(SceneChange::geometry, "shape" + of);
    }
}

void compare_media(const Scene& before, const Scene& after, Differences& differences) {
    for (std::size_t m = 0; m < after.media.size(); ++m) {
        const Medium &a = before.media[m], &b = after.media[m];
        const std::string of = fmt::format(" of medium \"{}\"", b.name);
        // A medium without extinction is empty space: another mesh of zones.
        const auto empty = [](const Medium& medium) {
            return std::all_of(medium.extinction.begin(), medium.extinction.end(),
                               [](double kappa) { return kappa == 0.0; });
        };
        differences.compare(a.extinction, b.extinction,
                            empty(a) == empty(b) ? SceneChange::optics : SceneChange::geometry,
                            "extinction" + of);
        if (!same_shapes(a.shape, b.shape))
            differences.add(SceneChange::geometry, "shape of the extinction" + of);
        differences.compare(a.albedo, b.albedo, SceneChange::optics, "albedo" + of);
        differences.compare(a.asymmetry, b.asymmetry, SceneChange::optics, "phase" + of);
        differences.compare(a.phase, b.phase, SceneChange::optics, "kind of phase" + of);
        differences.compare_source(a.emission, b.emission, "emission" + of);
        differences.compare_source(a.heat, b.heat, "heat" + of);
        differences.compare(a.at, b.at, SceneChange::geometry, "at" + of);
    }
}

void compare_shapes(const Sun& a, const Sun& b, const std::string& of, Differences& differences) {
    differences.compare(a.direction, b.direction, SceneChange::lights, "direction" + of);
    differences.compare(a.angle, b.angle, SceneChange::lights, "angle" + of);
    differences.compare_source(a.irradiance, b.irradiance, "irradiance" + of);
}

void compare_shapes(const PointLight& a, const PointLight& b, const std::string& of,
                    Differences& differences) {
    differences.compare(a.position, b.position, SceneChange::lights, "position" + of);
    differences.compare_source(a.intensity, b.intensity, "intensity" + of);
}

void compare_shapes(const SpotLight& a, const SpotLight& b, const std::string& of,
                    Differences& differences) {
    differences.compare(a.position, b.position, SceneChange::lights, "position" + of);
    differences.compare(a.direction, b.direction, SceneChange::lights, "direction" + of);
    differences.compare(a.angle, b.angle, SceneChange::lights, "angle" + of);
    differences.compare(a.soft_edge, b.soft_edge, SceneChange::lights, "soft edge" + of);
    differences.compare_source(a.intensity, b.intensity, "intensity" + of);
}

void compare_lights(const Scene& before, const Scene& after, Differences& differences) {
    for (std::size_t l = 0; l < after.lights.size(); ++l) {
        const Light &a = before.lights[l], &b = after.lights[l];
        const std::string of = fmt::format(" of light \"{}\"", b.name);
        if (a.source.index() != b.source.index()) {
            differences.add(SceneChange::lights, "kind" + of);
            continue;
        }
        std::visit(
            [&](const auto& light) {
                using Kind = std::decay_t<decltype(light)>;
                compare_shapes(std::get<Kind>(a.source), light, of, differences);
            },
            b.source);
    }
}

}  // namespace

SceneDifference compare_scenes(const Scene& before, const Scene& after) {
    Differences differences;
    differences.compare(before.bands, after.bands, SceneChange::geometry, "bands");
    if (!same_bands(before.spectral, after.spectral))
        differences.add(SceneChange::optics, "what bands are");
    const auto count = [&](const auto& a, const auto& b, SceneChange change, const char* what) {
        if (a.size() == b.size()) return true;
        differences.add(change, what);
        return false;
    };
    if (count(before.materials, after.materials, SceneChange::geometry, "number of materials"))
        compare_materials(before, after, differences);
    if (count(before.surfaces, after.surfaces, SceneChange::geometry, "number of surfaces"))
        compare_surfaces(before, after, differences);
    if (count(before.media, after.media, SceneChange::geometry, "number of media"))
        compare_media(before, after, differences);
    if (count(before.lights, after.lights, SceneChange::lights, "number of lights"))
        compare_lights(before, after, differences);
    differences.compare_source(before.environment, after.environment, "environment");
    differences.compare(before.viewpoints, after.viewpoints, SceneChange::geometry, "viewpoints");
    differences.compare(before.thermal, after.thermal, SceneChange::optics, "temperatures");
    SceneDifference result = std::move(differences).result();
    if (result.change == SceneChange::emission && finds_temperatures(after))
        result.change = SceneChange::optics;
    return result;
}

}  // namespace tyndall::radiosity
