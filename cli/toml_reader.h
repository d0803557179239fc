// Reads tables of a TOML file: every key known, every value of the right type and in range, every
// complaint with its place. Places are file:line:column, or "--set key=value" for an overridden
// value.
#pragma once

#include <toml++/toml.h>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall::cli {

// A key that a table may hold. The same list makes the errors and the reference in the
// documentation.
struct Key {
    std::string_view name;
    std::string_view type;      // "number [1/m], or one value a band"
    std::string_view fallback;  // value if left out; "required"; "" if there is nothing to say
    std::string_view meaning;
};

struct KeyTable {
    std::string_view title;  // "[[material]]"
    std::vector<Key> keys;

    std::vector<std::string_view> names() const;
    const Key* find(std::string_view name) const;
};

// Numbers from `low` to `high`.
struct Range {
    double low = -std::numeric_limits<double>::max(), high = std::numeric_limits<double>::max();
    bool low_open = false, high_open = false;  // the end itself does not belong to it

    bool holds(double value) const;
    std::string text()
        const;  // behind "a value": "from 0 to 1", "above 0 and below 180", "of 0 or more"
};

// Quantities beyond 1e30, lengths beyond 1e9 m: their products would leave what a double holds.
inline constexpr Range quantity{0.0, 1e30};
inline constexpr Range positive{0.0, 1e30, true};
inline constexpr Range fraction{0.0, 1.0};
inline constexpr Range coordinate{-1e9, 1e9};

// Where a node of a parsed file stands.
std::string place_of(const toml::source_region& source);
// "a string", "an array", …
std::string_view type_of(const toml::node& node);

// Throws mesh::InputError "place: message".
[[noreturn]] void fail_at(const std::string& place, const std::string& message);

// One table with its known keys. Constructing it refuses unknown keys. `thing` is what messages
// call it: `material "plaster"`. The table must outlive it. All accessors throw mesh::InputError.
class TableReader {
  public:
    TableReader(const toml::table& table, const KeyTable& keys, std::string thing);

    const toml::table& table() const { return *table_; }
    const std::string& thing() const { return thing_; }
    bool has(std::string_view key) const { return table_->contains(key); }
    std::string where() const { return place_of(table_->source()); }
    // The place of the key's value; of the table if it is not there.
    std::string where(std::string_view key) const;
    [[noreturn]] void fail(std::string_view key, const std::string& message) const;

    const toml::node& node(std::string_view key) const;  // required
    double number(std::string_view key, const Range& range) const;
    double number(std::string_view key, const Range& range, double fallback) const;
    std::size_t count(std::string_view key, std::size_t low, std::size_t high) const;
    std::string text(std::string_view key) const;
    bool flag(std::string_view key) const;  // true or false
    // The index of the text among `names`.
    std::size_t choice(std::string_view key, std::span<const std::string_view> names) const;
    // The names in an array, each one of `names`.
    std::vector<std::string> choices(std::string_view key,
                                     std::span<const std::string_view> names) const;
    glm::dvec3 vector(std::string_view key, const Range& range) const;
    glm::dvec2 vector2(std::string_view key, const Range& range) const;
    // One value a band, from one number or an array of `bands`.
    std::vector<double> spectrum(std::string_view key, std::size_t bands, const Range& range) const;
    const toml::array& array(std::string_view key) const;
    // `thing` defaults to "key of this thing".
    TableReader table(std::string_view key, const KeyTable& keys, std::string thing = {}) const;
    // The tables of [[key]]; empty if there are none.
    std::vector<const toml::table*> tables(std::string_view key) const;

    // Which of the keys is given; none if none is. More than one is an error.
    std::optional<std::string_view> at_most_one(std::span<const std::string_view> keys) const;
    std::string_view exactly_one(std::span<const std::string_view> keys) const;

    // A finite number in range, found at `node`; `what` is "reflectance of material …".
    double number_at(const toml::node& node, const std::string& what, const Range& range) const;
    glm::dvec3 vector_at(const toml::node& node, const std::string& what, const Range& range) const;

  private:
    std::size_t choice_at(const toml::node& node, const std::string& what,
                          std::span<const std::string_view> names) const;
    std::string what(std::string_view key) const;  // "reflectance of material \"plaster\""
    std::vector<double> numbers_at(const toml::node& node, std::string_view key, std::size_t size,
                                   const Range& range) const;

    const toml::table* table_;
    const KeyTable* keys_;
    std::string thing_;
};

}  // namespace tyndall::cli
