#include "render/renderers.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "mesh/input_error.h"
#include "render/last_scatter.h"
#include "render/line_of_sight.h"
#include "render/path_traced.h"
#include "render/projected_zones.h"
#include "render/two_pass.h"

namespace tyndall::render {
namespace {

constexpr NamedRenderer all[]{
    {"line_of_sight", line_of_sight, true},          {"projected_zones", projected_zones},
    {"last_scatter", last_scatter, false, true},     {"two_pass", two_pass, false, true},
    {"path_traced", path_traced_scene, false, true},
};

}  // namespace

std::span<const NamedRenderer> renderers() {
    return all;
}

std::vector<std::string_view> renderer_names() {
    std::vector<std::string_view> names;
    for (const auto& renderer : all) names.push_back(renderer.name);
    return names;
}

const NamedRenderer& renderer_named(std::string_view name) {
    const auto found = std::ranges::find(all, name, &NamedRenderer::name);
    if (found != std::end(all)) return *found;
    throw mesh::InputError(fmt::format("there is no render method \"{}\". Choose one of {}.", name,
                                       fmt::join(renderer_names(), ", ")));
}

void refuse_bodies(const radiosity::Enclosure& enclosure, std::string_view advice) {
    if (enclosure.mesh.bodies.empty()) return;
    const auto sides = enclosure.facet_sides[enclosure.mesh.bodies.front().first.value];
    const auto side = sides[0] != radiosity::none ? sides[0] : sides[1];
    const std::string name =
        side == radiosity::none ? "an object" : fmt::format("\"{}\"", enclosure.sides[side].name);
    throw mesh::InputError(
        fmt::format("{} moves through the mesh without being cut into it, {}, or solve the scene "
                    "of this frame by "
                    "itself.",
                    name, advice));
}

}  // namespace tyndall::render
