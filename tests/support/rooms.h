// Scenes of radiosity tests, from the ground up.
#pragma once

#include <string>

#include "mesh/shapes.h"
#include "radiosity/enclosure.h"

namespace tyndall::test {

inline radiosity::Material material(double reflectance, double emission = 0.0) {
    radiosity::Material m;
    m.reflectance = {reflectance};
    if (emission > 0.0) m.emission = {emission};
    return m;
}

// The surfaces of a shape, all of one material (none: interfaces).
inline void add_surfaces(radiosity::Scene& scene, const std::string& name,
                         const std::vector<mesh::Face>& faces,
                         std::optional<std::size_t> material) {
    for (const auto& face : faces) {
        radiosity::Surface surface;
        surface.name = face.name.empty() ? name : name + "." + face.name;
        surface.polygons = face.polygons;
        surface.material = material;
        for (auto& polygon : surface.polygons) {
            polygon.name = surface.name;
            if (!material) polygon.opacity = mesh::Opacity::interface;
        }
        scene.surfaces.push_back(surface);
    }
}

inline radiosity::Medium medium(double extinction, double albedo,
                                std::optional<mesh::Point> at = {}) {
    radiosity::Medium m;
    m.name = "haze";
    m.extinction = {extinction};
    m.albedo = {albedo};
    m.at = at;
    return m;
}

inline std::size_t surface_named(const radiosity::Scene& scene, const std::string& name) {
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
        if (scene.surfaces[s].name == name) return s;
    throw std::runtime_error("no surface " + name);
}

// A 3 × 2 × 2 m room in fog with a lamp in the ceiling and a slit partition; lengths times `scale`.
inline radiosity::Scene slit_room(double scale = 1.0) {
    radiosity::Scene scene;
    scene.materials = {material(0.6), material(0.0, 10.0)};
    add_surfaces(scene, "room", mesh::room({0, 0, 0}, scale * mesh::Point(3, 2, 2)), 0);
    add_surfaces(
        scene, "left",
        mesh::rectangle(scale * mesh::Point(1.5, 0, 0), {0, 0.9 * scale, 0}, {0, 0, 2 * scale}), 0);
    add_surfaces(
        scene, "right",
        mesh::rectangle(scale * mesh::Point(1.5, 1.1, 0), {0, 0.9 * scale, 0}, {0, 0, 2 * scale}),
        0);
    add_surfaces(
        scene, "lamp",
        mesh::rectangle(scale * mesh::Point(0.5, 0.8, 2), {0, 0.4 * scale, 0}, {0.4 * scale, 0, 0}),
        1);
    scene.media = {medium(0.25 / scale, 0.9)};
    return scene;
}

}  // namespace tyndall::test
