// Overrides as a study file writes them: tables of dotted keys.
#pragma once

#include <vector>

#include "cli/study_file.h"
#include "cli/toml_reader.h"

namespace tyndall::cli {

// An entry of a table, with the tables in it opened: "solve.error" = …, solve.error = … and
// solve = { error = … } are the same.
struct DottedEntry {
    std::string key;
    const toml::node* node;
    std::string place;  // of the key
};

// In the file's order.
std::vector<DottedEntry> dotted_entries(const toml::table& table);

// The entries as overrides, each with the place of its value.
std::vector<PlacedSetting> placed_settings(const toml::table& table);

// A value's text for people: a string without its quotes, all else as TOML writes it.
std::string label_of(const toml::node& node);

}  // namespace tyndall::cli
