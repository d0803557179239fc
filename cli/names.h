// Names of materials, surfaces, media, lights, cameras.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "cli/toml_reader.h"

namespace tyndall::cli {

// Why a name cannot be used; empty if it can. A name may not be empty, begin or end with a space,
// or hold what has a meaning elsewhere: '.' (room.floor), '+' anywhere and '-' at the end (the
// sides room+ and room-), '=' ',' '"' and control characters (--set, CSV). "outside" is what lies
// beyond.
std::string name_trouble(const std::string& name);

// The names of one kind, with their places; keeps them unique.
class Names {
  public:
    explicit Names(std::string kind) : kind_(std::move(kind)) {}

    // Reads `name` of a [[kind]] table and takes it. Throws mesh::InputError if it is missing, not
    // usable, or taken.
    std::string take(const toml::table& table);
    // Takes a name that was made from others ("room.floor").
    void take(const std::string& name, const std::string& place);

    // The index of the name in the order of taking. Throws mesh::InputError at the key's place.
    std::size_t find(const TableReader& reader, std::string_view key) const;
    const std::vector<std::string>& all() const { return order_; }

  private:
    std::string kind_;
    std::vector<std::string> order_;
    std::map<std::string, std::string> places_;
};

}  // namespace tyndall::cli
