#include "radiosity/exchange_methods.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "mesh/input_error.h"
#include "radiosity/exchange_ray_traced_pairs.h"
#include "radiosity/exchange_walked.h"

namespace tyndall::radiosity {
namespace {

constexpr NamedExchangeMethod methods[]{
    {"walked", exchange_walked, true, true, true},
    {"ray_traced_pairs", exchange_ray_traced_pairs, false, false, true},
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
