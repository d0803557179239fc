#include "cli/scene_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <set>

#include "cli/solution_bytes.h"

namespace tyndall::cli {
namespace {

using mesh::Point;

// Measured on the example scenes; good within a factor of two.
constexpr double process_bytes = 35e6;
constexpr double crossings = 10.0;         // elements that a ray of a row meets
constexpr double start_elements = 5500.0;  // of the coarse solution, if the base mesh has fewer

double polygon_area(const std::vector<Point>& corners) {
    glm::dvec3 sum(0.0);
    for (std::size_t k = 1; k + 1 < corners.size(); ++k)
        sum += glm::cross(corners[k] - corners[0], corners[k + 1] - corners[0]);
    return 0.5 * glm::length(sum);
}

// Regions by volume: media, empty space, solids.
void measure_regions(const radiosity::Enclosure& e, const std::vector<std::string>& around,
                     SceneStatistics& s) {
    std::vector<double> volumes(e.mesh.region_count, 0.0);
    for (std::size_t t = 0; t < e.mesh.tets.size(); ++t)
        volumes[e.mesh.regions[t].value] += mesh::volume(e.mesh, mesh::TetId(t));
    for (const auto& medium : e.media) s.media.push_back({medium.name, 0.0});
    for (std::size_t r = 0; r < volumes.size(); ++r) {
        const auto medium = e.region_medium[r];
        if (e.region_solid[r])
            s.solids.push_back({around[r], volumes[r]});
        else if (medium != radiosity::none)
            s.media[medium].size += volumes[r];
        else
            s.empty_volume += volumes[r];
    }
}

// A name for every region: those of the surfaces around it whose sides face something else.
std::vector<std::string> names_around(const radiosity::Enclosure& e) {
    std::vector<std::set<std::string>> names(e.mesh.region_count);
    for (std::size_t f = 0; f < e.mesh.facets.size(); ++f)
        for (const int k : {0, 1}) {
            const auto side = e.facet_sides[f][1 - k];
            const auto tet = e.mesh.facets[f].tets[k];
            if (side == radiosity::none || !tet.valid()) continue;
            const std::string& name = e.sides[side].name;
            names[e.mesh.regions[tet.value].value].insert(name.substr(0, name.find_first_of(".+")));
        }
    std::vector<std::string> texts;
    for (auto& set : names) {
        std::string text;
        for (std::string name : set) {
            if (name.ends_with('-')) name.pop_back();
            if (text.find(name) == std::string::npos) text += (text.empty() ? "" : "/") + name;
        }
        texts.push_back("behind " + (text.empty() ? "walls" : text));
    }
    return texts;
}

double open_hull_area(const radiosity::Enclosure& e) {
    double area = 0.0;
    for (std::size_t t = 0; t < e.mesh.tets.size(); ++t) {
        if (e.solid(mesh::TetId(t))) continue;
        for (int k = 0; k < 4; ++k) {
            if (e.mesh.neighbours[t][k].valid()) continue;
            std::vector<Point> corners;
            for (int c = 1; c < 4; ++c)
                corners.push_back(e.mesh.points[e.mesh.tets[t][(k + c) % 4].value]);
            area += polygon_area(corners);
        }
    }
    return area;
}

void foresee_memory(const SceneFile& file, const radiosity::Enclosure& e, SceneStatistics& s) {
    const double bands = static_cast<double>(e.bands);
    const double roots = static_cast<double>(2 * e.mesh.facets.size() + e.mesh.tets.size());
    const double limit = static_cast<double>(file.solve.max_elements);
    const double coarse = std::min(limit, std::max(start_elements, roots));
    const double per_row = std::min(coarse, crossings * static_cast<double>(file.solve.rays));
    const double per_element = leaf_bytes + leaf_band_bytes * bands;
    const bool moments = file.solve.radiance != radiosity::Radiance::constant &&
                         !(file.solve.row_detail > 0.0) &&
                         file.solve.start != radiosity::Start::single_zone;
    const bool smoothed = file.solve.exchange_settings.smoothing != radiosity::Smoothing::none;
    // Moments of smoothed rows: those as made, and those of the union, twice as many.
    const double moment = moments ? moment_bytes * (smoothed ? 3.0 : 1.0) : 0.0;
    const double rows =
        coarse * per_row * (entry_bytes + (smoothed ? smoothing_bytes : 0.0) + moment);
    double pixels = 0.0;
    for (const auto& camera : file.cameras)
        pixels = std::max(pixels, static_cast<double>(camera.width * camera.height));
    const double picture = pixels * 4.0 * (7.0 * bands + 1.0);
    s.memory_start = process_bytes + rows + coarse * per_element;
    s.memory_most = std::min(process_bytes + rows + limit * per_element,
                             process_bytes + static_cast<double>(file.solve.max_memory)) +
                    picture;
    s.memory_most = std::max(s.memory_most, s.memory_start);
}

}  // namespace

SceneStatistics statistics_of(const SceneFile& file, const radiosity::Enclosure& e) {
    SceneStatistics s;
    s.triangles = e.mesh.facets.size();
    s.tetrahedra = e.mesh.tets.size();
    s.bands = e.bands;
    s.hull_min = e.mesh.hull_min;
    s.hull_max = e.mesh.hull_max;
    for (const auto& surface : file.scene.surfaces) {
        s.polygons += surface.polygons.size();
        if (surface.material) continue;
        double area = 0.0;
        for (const auto& polygon : surface.polygons) area += polygon_area(polygon.corners);
        s.openings.push_back({surface.name, area});
    }
    for (const auto& side : e.sides) s.sides.push_back({side.name, side.area});
    measure_regions(e, names_around(e), s);
    s.open = e.open;
    s.hull_area = open_hull_area(e);
    for (const auto& light : e.lights) s.lights.push_back(light.name);
    for (const auto& side : e.sides)
        if (std::any_of(side.emission.begin(), side.emission.end(), [](double v) { return v > 0; }))
            s.lights.push_back(side.name);
    for (const auto& camera : file.cameras) s.cameras.push_back(camera.name);
    foresee_memory(file, e, s);
    s.warnings = e.warnings;
    return s;
}

}  // namespace tyndall::cli
