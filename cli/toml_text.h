// Parsed TOML back to text: numbers in their shortest form, tables and keys in the file's order.
#pragma once

#include <toml++/toml.h>
#include <string>

namespace tyndall::cli {

// A whole document, which parses to the same values, to the last bit.
std::string toml_text(const toml::table& root);

// One value on one line, which parses to the same value.
std::string whole_text_of(const toml::node& node);

// One value on one line, cut to 60 bytes: for messages.
std::string text_of(const toml::node& node);

}  // namespace tyndall::cli
