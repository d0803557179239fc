#include "radiosity/exchange_methods.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "mesh/input_error.h"
#include "radiosity/exchange_full_cube.h"
#include "radiosity/exchange_hemicube.h"
#include "radiosity/exchange_single_plane.h"
#include "radiosity/exchange_walked.h"

namespace tyndall::radiosity {
namespace {

constexpr NamedExchangeMethod methods[]{
    {"walked", exchange_walked, true, true},
    {"full_cube", exchange_full_cube},
    {"hemicube", exchange_hemicube},
    {"single_plane", exchange_single_plane},
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

}  // namespace tyndall::radiosity
