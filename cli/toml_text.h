// TOML files read, and parsed TOML back to text: numbers in their shortest form, tables and keys in
// the file's order.
#pragma once

#include <toml++/toml.h>
#include <filesystem>
#include <string>

namespace tyndall::cli {

// The file parsed. `thing` is what messages call it: "scene". Throws mesh::InputError: no such
// file, a directory, not readable, no valid TOML.
toml::table parse_toml_file(const std::filesystem::path& path, const std::string& thing);

// A whole document, which parses to the same values, to the last bit.
std::string toml_text(const toml::table& root);

// One value on one line, which parses to the same value.
std::string whole_text_of(const toml::node& node);

// One value on one line, cut to 60 bytes: for messages.
std::string text_of(const toml::node& node);

}  // namespace tyndall::cli
