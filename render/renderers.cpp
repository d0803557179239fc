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
    {"line_of_sight", line_of_sight},         {"projected_zones", projected_zones},
    {"last_scatter", last_scatter, true},     {"two_pass", two_pass, true},
    {"path_traced", path_traced_scene, true},
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

}  // namespace tyndall::render
