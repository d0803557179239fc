#include "radiosity/scene_builder.h"

#include <fmt/format.h>

#include <algorithm>

#include "mesh/input_error.h"

namespace tyndall::radiosity {

namespace {

std::size_t add_material(Scene& scene, Material material, const std::string& name) {
    if (material.name.empty()) material.name = name;
    scene.materials.push_back(std::move(material));
    return scene.materials.size() - 1;
}

bool is_opening(const mesh::Face& face) {
    return !face.polygons.empty() && face.polygons[0].opacity == mesh::Opacity::interface;
}

}  // namespace

void add_surface(Scene& scene, const std::string& name, const std::vector<mesh::Face>& shape,
                 Material material, std::optional<Material> back) {
    std::vector<Surface> surfaces;
    for (const auto& face : shape) {
        Surface surface{face.name.empty() ? name : name + "." + face.name, face.polygons, {}, {}};
        for (auto& polygon : surface.polygons) polygon.name = surface.name;
        if (std::any_of(scene.surfaces.begin(), scene.surfaces.end(),
                        [&](const Surface& other) { return other.name == surface.name; }))
            throw mesh::InputError(fmt::format(
                "There is a surface \"{}\" already. Give this one another name.", surface.name));
        surfaces.push_back(std::move(surface));
    }
    if (back) material.back = add_material(scene, std::move(*back), name + " back");
    const std::size_t index = add_material(scene, std::move(material), name);
    for (std::size_t s = 0; s < shape.size(); ++s) {
        if (!is_opening(shape[s])) surfaces[s].material = index;
        scene.surfaces.push_back(std::move(surfaces[s]));
    }
}

}  // namespace tyndall::radiosity
