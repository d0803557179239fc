#include "radiosity/exchange_methods.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "mesh/input_error.h"
#include "radiosity/exchange_contour_integration.h"
#include "radiosity/exchange_full_cube.h"
#include "radiosity/exchange_hemicube.h"
#include "radiosity/exchange_point_to_polygon.h"
#include "radiosity/exchange_ray_traced_pairs.h"
#include "radiosity/exchange_reference_pairs.h"
#include "radiosity/exchange_single_plane.h"
#include "radiosity/exchange_walked.h"

namespace tyndall::radiosity {
namespace {

constexpr NamedExchangeMethod methods[]{
    {.name = "walked",
     .method = exchange_walked,
     .varying = true,
     .walks = true,
     .moments = true,
     .detail = true,
     .radius = true,
     .mirrors = true,
     .of_bands = exchange_walked_bands},
    {.name = "contour_integration",
     .method = exchange_contour_integration,
     .zones = false,
     .occlusion = false,
     .media = false},
    {.name = "point_to_polygon", .method = exchange_point_to_polygon, .zones = false},
    {.name = "reference_pairs", .method = exchange_reference_pairs},
    {.name = "ray_traced_pairs", .method = exchange_ray_traced_pairs, .radius = true},
    {.name = "full_cube", .method = exchange_full_cube},
    {.name = "hemicube", .method = exchange_hemicube, .zones = false},
    {.name = "single_plane", .method = exchange_single_plane, .zones = false},
};

}  // namespace

std::span<const NamedExchangeMethod> exchange_methods() {
    return methods;
}

const NamedExchangeMethod& exchange_method(std::string_view name) {
    const auto found = std::ranges::find(methods, name, &NamedExchangeMethod::name);
    if (found != std::end(methods)) return *found;
    std::vector<std::string_view> names;
    for (const auto& method : methods) names.push_back(method.name);
    throw mesh::InputError(fmt::format("there is no exchange method \"{}\". Choose one of {}.",
                                       name, fmt::join(names, ", ")));
}

void refuse_pair(const Discretization& d, std::string_view method, ElementId i, ElementId j,
                 std::string_view why, bool NamedExchangeMethod::*ability) {
    std::vector<std::string_view> able;
    for (const auto& other : methods)
        if (other.*ability && other.name != method) able.push_back(other.name);
    const auto name = [&](ElementId id) { return name_of(d.enclosure, d.forest, d.elements, id); };
    throw mesh::InputError(fmt::format("{} cannot do the pair {}, {}: {}. Those that can: {}.",
                                       method, name(i), name(j), why, fmt::join(able, ", ")));
}

void require_media(const NamedExchangeMethod& method, const Enclosure& enclosure) {
    if (method.varying) return;
    const auto medium = std::ranges::find_if(
        enclosure.media, [](const MediumOptics& m) { return !m.varying.empty(); });
    if (medium == enclosure.media.end()) return;
    std::vector<std::string_view> names;
    for (const auto& other : methods)
        if (other.varying) names.push_back(other.name);
    throw mesh::InputError(fmt::format(
        "exchange method \"{}\" needs one extinction a medium; that of \"{}\" varies in space. Set "
        "exchange to {}.",
        method.name, medium->name, fmt::join(names, " or ")));
}

void require_mirrors(const NamedExchangeMethod& method, const Enclosure& enclosure) {
    if (method.mirrors) return;
    const auto side = std::ranges::find_if(enclosure.sides,
                                           [](const SurfaceSide& s) { return !s.mirror.empty(); });
    if (side == enclosure.sides.end()) return;
    std::vector<std::string_view> names;
    for (const auto& other : methods)
        if (other.mirrors) names.push_back(other.name);
    throw mesh::InputError(fmt::format(
        "exchange method \"{}\" does not follow light that \"{}\" mirrors. Set exchange to {}, or "
        "mirrors to scattered.",
        method.name, side->name, fmt::join(names, " or ")));
}

void require_settings(const NamedExchangeMethod& method, const ExchangeSettings& settings) {
    if (!(settings.interaction_radius > 0.0) || method.radius) return;
    std::vector<std::string_view> names;
    for (const auto& other : methods)
        if (other.radius) names.push_back(other.name);
    throw mesh::InputError(
        fmt::format("exchange method \"{}\" has no interaction radius ({} m is set). Set "
                    "interaction_radius to 0, or exchange to one of {}.",
                    method.name, settings.interaction_radius, fmt::join(names, ", ")));
}

}  // namespace tyndall::radiosity
