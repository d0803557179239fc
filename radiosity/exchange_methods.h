// The methods for exchange areas by name.
#pragma once

#include <string_view>

#include "radiosity/exchange.h"

namespace tyndall::radiosity {

struct NamedExchangeMethod {
    std::string_view name;
    ExchangeMethod method;
    bool zones = true;      // can: pairs with zones
    bool occlusion = true;  //   pairs with something in the way
    bool media = true;      //   patches with a medium between them
    bool varying = false;   //   media whose extinction varies in space
    bool walks = false;     // makes rows of ExchangeOptions::rays rays
    bool moments = false;   //   first moments, so that elements hold linear functions
    bool detail = false;    //   deposits in coarser elements (ExchangeOptions::detail)
    bool radius = false;    //   heeds ExchangeSettings::interaction_radius
    bool mirrors = false;   //   goes on at mirrors
    BandsExchangeMethod of_bands = nullptr;  // makes rows of several bands at once
};

// The default first.
std::span<const NamedExchangeMethod> exchange_methods();

// Errors: mesh::InputError that lists the names there are.
const NamedExchangeMethod& exchange_method(std::string_view name);

// Throws the mesh::InputError of a pair that `method` cannot do: names both elements, says why, and
// which methods have `ability`.
[[noreturn]] void refuse_pair(const Discretization& d, std::string_view method, ElementId i,
                              ElementId j, std::string_view why,
                              bool NamedExchangeMethod::*ability);

// Errors: mesh::InputError if the extinction of a medium varies in space, and the method needs one
// that does not; it names those that do not need it.
void require_media(const NamedExchangeMethod& method, const Enclosure& enclosure);

// Errors: mesh::InputError if walks go on at a side of the enclosure, and the method cannot.
void require_mirrors(const NamedExchangeMethod& method, const Enclosure& enclosure);

// Errors: mesh::InputError if the settings ask for what the method does not know.
void require_settings(const NamedExchangeMethod& method, const ExchangeSettings& settings);

}  // namespace tyndall::radiosity
