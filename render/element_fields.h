// What the elements of a solution hold, by name: one number at a point of an element.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "radiosity/solution.h"

namespace tyndall::render {

// Means over the bands.
struct NamedField {
    std::string_view name, unit;
    bool logarithmic;  // how it is best shown
    double (*of_zone)(const radiosity::Solution&, mesh::ZoneId, mesh::Point);
    double (*of_patch)(const radiosity::Solution&, mesh::PatchId, mesh::Point);
};

// radiance: J of zones, I of patches; direct, indirect, and incident: H, both; error: estimated, of
// incident light [all W/m^2/sr]; temperature (43), NaN where there is none [K]; level: bisections
// below the base mesh; extinction [1/m] of zones (0 of patches); albedo of zones and reflectance of
// patches.
std::span<const NamedField> element_fields();

std::vector<std::string_view> field_names();

// Errors: mesh::InputError that lists the fields there are.
const NamedField& field_named(std::string_view name);

}  // namespace tyndall::render
