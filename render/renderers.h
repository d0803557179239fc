// The renderers by name: how a picture is made from a solution.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "radiosity/progress.h"
#include "radiosity/solution.h"
#include "render/camera.h"
#include "render/image.h"
#include "render/options.h"

namespace tyndall::render {

using Renderer = Image (*)(const radiosity::Solution&, const Camera&, const RenderOptions&,
                           const radiosity::ProgressCallback&);

struct NamedRenderer {
    std::string_view name;
    Renderer render;
    bool bodies = false;  // sees what moves as a body in the mesh (mesh/body.h); others refuse it
    bool draws_lots = false;  // heeds RenderOptions::error and time, and has a layer "error"
};

// The default first.
std::span<const NamedRenderer> renderers();

std::vector<std::string_view> renderer_names();

// Errors: mesh::InputError that lists the names there are.
const NamedRenderer& renderer_named(std::string_view name);

// Of methods that do not see what moves as a body in the mesh (mesh/body.h).
// `advice`: who can, and what to do; "or solve the scene of this frame by itself" follows.
// Errors: mesh::InputError where there is such a body, with its name.
void refuse_bodies(
    const radiosity::Enclosure& enclosure,
    std::string_view advice = "which line_of_sight alone can draw. Choose that method");

}  // namespace tyndall::render
