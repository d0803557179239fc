// The methods for exchange areas by name.
#pragma once

#include <string_view>

#include "radiosity/exchange.h"

namespace tyndall::radiosity {

struct NamedExchangeMethod {
    std::string_view name;
    ExchangeMethod method;
    bool moments = false;  // makes first moments: elements may hold linear functions
    bool detail = false;   // can deposit in coarser elements (ExchangeOptions::detail)
    bool radius = false;   // knows ExchangeSettings::interaction_radius
};

// The default first.
std::span<const NamedExchangeMethod> exchange_methods();

// Errors: mesh::InputError that lists the names there are.
const NamedExchangeMethod& exchange_method(std::string_view name);

// Errors: mesh::InputError if the settings ask for what the method does not know.
void require_settings(const NamedExchangeMethod& method, const ExchangeSettings& settings);

}  // namespace tyndall::radiosity
