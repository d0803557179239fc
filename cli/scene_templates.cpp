#include "cli/scene_templates.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "cli/suggestion.h"
#include "mesh/input_error.h"

namespace tyndall::cli {
namespace {

constexpr std::array<SceneTemplate, 4> templates{{
    {"room", "a room with a window, a lamp and haze, in the sun", ""},
    {"louvres", "the sun through slats before a window: sheets of light", ""},
    {"furnace", "hot gas over a cooled load in adiabatic walls: fluxes and temperatures", ""},
    {"model", "a model from a file in fog, under a spot light", "model.obj"},
}};

void replace_all(std::string& text, std::string_view what, std::string_view by) {
    for (std::size_t at = 0; (at = text.find(what, at)) != text.npos; at += by.size())
        text.replace(at, what.size(), by);
}

}  // namespace

std::span<const SceneTemplate> scene_templates() {
    return templates;
}

const SceneTemplate& scene_template(std::string_view name) {
    const auto found = std::find_if(templates.begin(), templates.end(),
                                    [&](const SceneTemplate& t) { return t.name == name; });
    if (found != templates.end()) return *found;
    std::vector<std::string_view> names;
    for (const auto& known : templates) names.push_back(known.name);
    throw mesh::InputError(fmt::format("there is no template \"{}\". {}", name,
                                       suggest(name, std::span<const std::string_view>(names))));
}

std::string scene_of_template(const SceneTemplate& scene, const std::string& file,
                              const std::string& model) {
    std::string text(template_text(std::string(scene.name) + ".toml"));
    replace_all(text, "@FILE@", file);
    replace_all(text, "@MODEL@", model);
    return text;
}

}  // namespace tyndall::cli
