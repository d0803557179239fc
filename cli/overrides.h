// --set key=value: edits the parsed scene file before it is read.
#pragma once

#include <toml++/toml.h>
#include <string>

namespace tyndall::cli {

// `text` is "material.plaster.reflectance=0.3": keys joined by dots, elements of arrays by their
// name (in quotes if it holds a dot), then a TOML value; what is no TOML but looks like no broken
// one either (uniform, 2 GB) is taken as a string. The value's source path is "--set " + text,
// which is how later complaints about it name their place (place_of). Tables that are missing are
// made. Throws mesh::InputError if there is no '=', no key, no element of that name, or no valid
// value. Whether the key itself is known is found out when the scene is read.
void apply_override(toml::table& root, const std::string& text);

}  // namespace tyndall::cli
