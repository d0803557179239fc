#include "cli/toml_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "cli/suggestion.h"
#include "cli/toml_text.h"
#include "mesh/input_error.h"

namespace tyndall::cli {
namespace {

constexpr double largest = 1e30;  // the end of a range without an end

// "180", "1e9".
std::string short_text(double value) {
    std::string text = fmt::format("{:g}", value);
    const auto exponent = text.find("e+");
    if (exponent == text.npos) return text;
    return text.substr(0, exponent + 1) +
           text.substr(std::min(text.find_first_not_of('0', exponent + 2), text.size()));
}

}  // namespace

std::vector<std::string_view> KeyTable::names() const {
    std::vector<std::string_view> result;
    for (const Key& key : keys) result.push_back(key.name);
    return result;
}

const Key* KeyTable::find(std::string_view name) const {
    for (const Key& key : keys) {
        if (key.name == name) return &key;
    }
    return nullptr;
}

bool Range::holds(double value) const {
    return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
}

std::string Range::text() const {
    const std::string from =
        low_open ? "above " + short_text(low) : "of " + short_text(low) + " or more";
    const std::string to = high_open ? "below " + short_text(high) : "up to " + short_text(high);
    const bool bounded_below = low > -largest, bounded_above = high < largest;
    if (!bounded_below) return bounded_above ? to : "that is finite";
    if (!bounded_above) return from;
    if (low_open) return from + " and " + to;
    return "from " + short_text(low) + (high_open ? " and " + to : " to " + short_text(high));
}

std::string place_of(const toml::source_region& source) {
    const std::string path = source.path ? *source.path : std::string();
    if (path.starts_with("--set ") || source.begin.line == 0) return path;
    return fmt::format("{}:{}:{}", path, source.begin.line, source.begin.column);
}

std::string_view type_of(const toml::node& node) {
    switch (node.type()) {
        case toml::node_type::table:
            return "a table";
        case toml::node_type::array:
            return "an array";
        case toml::node_type::string:
            return "a string";
        case toml::node_type::integer:
            return "an integer";
        case toml::node_type::floating_point:
            return "a number";
        case toml::node_type::boolean:
            return "a boolean";
        default:
            return "a date or time";
    }
}

void fail_at(const std::string& place, const std::string& message) {
    throw mesh::InputError(place + ": " + message);
}

namespace {

[[noreturn]] void fail_type(const toml::node& node, const std::string& what,
                            std::string_view expected) {
    const std::string value = node.is_table() ? "" : " (" + text_of(node) + ")";
    fail_at(place_of(node.source()), fmt::format("{} is {}{}; {} is expected. Give {}.", what,
                                                 type_of(node), value, expected, expected));
}

}  // namespace

TableReader::TableReader(const toml::table& table, const KeyTable& keys, std::string thing)
    : table_(&table), keys_(&keys), thing_(std::move(thing)) {
    // In the order of the file, so that the first mistake is the one reported.
    const toml::key* unknown = nullptr;
    for (const auto& [key, node] : table) {
        if (keys.find(key.str())) continue;
        const auto& at = key.source().begin;
        if (!unknown || at < unknown->source().begin) unknown = &key;
    }
    if (!unknown) return;
    fail_at(place_of(unknown->source()),
            fmt::format("unknown key \"{}\" in {}. {}", unknown->str(), thing_,
                        suggest(unknown->str(), keys.names())));
}

std::string TableReader::where(std::string_view key) const {
    const toml::node* found = table_->get(key);
    return place_of(found ? found->source() : table_->source());
}

void TableReader::fail(std::string_view key, const std::string& message) const {
    fail_at(where(key), message);
}

std::string TableReader::what(std::string_view key) const {
    return fmt::format("{} of {}", key, thing_);
}

const toml::node& TableReader::node(std::string_view key) const {
    const Key* known = keys_->find(key);
    assert(known && "a key must be in the table of known keys");
    if (const toml::node* found = table_->get(key)) return *found;
    fail_at(where(), fmt::format("{} has no {}. Add {} = … ({}).", thing_, key, key,
                                 known ? known->type : ""));
}

double TableReader::number_at(const toml::node& node, const std::string& what,
                              const Range& range) const {
    const auto value = node.value<double>();
    if (!value || !node.is_number()) fail_type(node, what, "a number");
    if (std::isfinite(*value) && range.holds(*value)) return *value;
    const auto split = what.find(" of ");  // "reflectance 1.3 of material …"
    const std::string subject = fmt::format("{} {}{}", what.substr(0, split), *value,
                                            split == what.npos ? "" : what.substr(split));
    const bool too_large = std::isfinite(*value) && std::abs(*value) >= largest;
    std::string wrong = "is not a value " + range.text();
    if (!std::isfinite(*value))
        wrong = "is not finite";
    else if (too_large)
        wrong = "is beyond " + short_text(largest);
    else if (!range.low_open && !range.high_open && range.high < largest && range.low > -largest)
        wrong = "is outside " + short_text(range.low) + " to " + short_text(range.high);
    fail_at(place_of(node.source()),
            fmt::format("{} {}. Give a {}.", subject, wrong,
                        too_large ? "smaller one" : "value " + range.text()));
}

double TableReader::number(std::string_view key, const Range& range) const {
    return number_at(node(key), what(key), range);
}

double TableReader::number(std::string_view key, const Range& range, double fallback) const {
    return has(key) ? number(key, range) : fallback;
}

std::size_t TableReader::count(std::string_view key, std::size_t low, std::size_t high) const {
    const toml::node& found = node(key);
    const double value = number_at(found, what(key), Range{double(low), double(high)});
    if (value != std::floor(value)) fail_type(found, what(key), "a whole number");
    return static_cast<std::size_t>(value);
}

std::string TableReader::text(std::string_view key) const {
    const toml::node& found = node(key);
    const auto value = found.value_exact<std::string>();
    if (!value) fail_type(found, what(key), "a string");
    return *value;
}

bool TableReader::flag(std::string_view key) const {
    const toml::node& found = node(key);
    const auto value = found.value_exact<bool>();
    if (!value) fail_type(found, what(key), "true or false");
    return *value;
}

std::size_t TableReader::choice_at(const toml::node& node, const std::string& what,
                                   std::span<const std::string_view> names) const {
    const auto value = node.value_exact<std::string>();
    if (!value) fail_type(node, what, "a string");
    const auto found = std::find(names.begin(), names.end(), *value);
    if (found == names.end()) {
        const auto near = nearest(*value, names);
        fail_at(place_of(node.source()),
                fmt::format(
                    "{} is \"{}\", which is not one of: {}. {}", what, *value, list_of(names, "or"),
                    near ? fmt::format("Did you mean \"{}\"?", *near) : "Give one of them."));
    }
    return static_cast<std::size_t>(found - names.begin());
}

std::size_t TableReader::choice(std::string_view key,
                                std::span<const std::string_view> names) const {
    return choice_at(node(key), what(key), names);
}

std::vector<std::string> TableReader::choices(std::string_view key,
                                              std::span<const std::string_view> names) const {
    std::vector<std::string> result;
    const std::string each = "an element of " + what(key);
    for (const toml::node& value : array(key))
        result.emplace_back(names[choice_at(value, each, names)]);
    return result;
}

std::vector<double> TableReader::numbers_at(const toml::node& node, std::string_view key,
                                            std::size_t size, const Range& range) const {
    const toml::array* values = node.as_array();
    if (!values) fail_type(node, what(key), fmt::format("an array of {} numbers", size));
    if (values->size() != size) {
        fail_at(place_of(node.source()),
                fmt::format("{} has {} value{}; {} are expected. Give {} numbers.", what(key),
                            values->size(), values->size() == 1 ? "" : "s", size, size));
    }
    std::vector<double> result;
    for (const toml::node& value : *values) {
        result.push_back(number_at(value, what(key), range));
    }
    return result;
}

glm::dvec3 TableReader::vector(std::string_view key, const Range& range) const {
    const auto values = numbers_at(node(key), key, 3, range);
    return {values[0], values[1], values[2]};
}

glm::dvec2 TableReader::vector2(std::string_view key, const Range& range) const {
    const auto values = numbers_at(node(key), key, 2, range);
    return {values[0], values[1]};
}

glm::dvec3 TableReader::vector_at(const toml::node& node, const std::string& what,
                                  const Range& range) const {
    const toml::array* values = node.as_array();
    if (!values) fail_type(node, what, "an array of 3 numbers");
    if (values->size() != 3) {
        fail_at(place_of(node.source()),
                fmt::format("{} has {} coordinates. Give three: [x, y, z].", what, values->size()));
    }
    glm::dvec3 result;
    for (int axis = 0; axis < 3; ++axis) {
        result[axis] = number_at((*values)[static_cast<std::size_t>(axis)], what, range);
    }
    return result;
}

std::vector<double> TableReader::spectrum(std::string_view key, std::size_t bands,
                                          const Range& range) const {
    const toml::node& found = node(key);
    if (!found.is_array()) {
        if (!found.is_number()) {
            fail_type(
                found, what(key),
                bands == 1 ? "a number" : fmt::format("a number or an array of {} numbers", bands));
        }
        return std::vector<double>(bands, number_at(found, what(key), range));
    }
    const std::size_t size = found.as_array()->size();
    if (size != bands) {
        fail(key,
             fmt::format("{} has {} value{} for {} band{}. Give one number for all bands, or {}.",
                         what(key), size, size == 1 ? "" : "s", bands, bands == 1 ? "" : "s",
                         bands == 1 ? "one in an array" : fmt::format("{} in an array", bands)));
    }
    return numbers_at(found, key, bands, range);
}

const toml::array& TableReader::array(std::string_view key) const {
    const toml::node& found = node(key);
    if (!found.is_array()) fail_type(found, what(key), "an array");
    return *found.as_array();
}

TableReader TableReader::table(std::string_view key, const KeyTable& keys,
                               std::string thing) const {
    const toml::node& found = node(key);
    if (!found.is_table()) fail_type(found, what(key), "a table");
    return TableReader(*found.as_table(), keys, thing.empty() ? what(key) : std::move(thing));
}

std::vector<const toml::table*> TableReader::tables(std::string_view key) const {
    std::vector<const toml::table*> result;
    if (!has(key)) return result;
    const toml::node& found = node(key);
    const std::string expected = fmt::format("an array of tables ([[{}]])", key);
    if (!found.is_array()) fail_type(found, what(key), expected);
    for (const toml::node& element : *found.as_array()) {
        if (!element.is_table()) fail_type(element, "an element of " + what(key), "a table");
        result.push_back(element.as_table());
    }
    return result;
}

std::optional<std::string_view> TableReader::at_most_one(
    std::span<const std::string_view> keys) const {
    std::optional<std::string_view> found;
    for (const std::string_view key : keys) {
        if (!has(key)) continue;
        if (found) {
            fail(key, fmt::format("{} has both {} and {}. Keep one of {}.", thing_, *found, key,
                                  list_of(keys, "or")));
        }
        found = key;
    }
    return found;
}

std::string_view TableReader::exactly_one(std::span<const std::string_view> keys) const {
    if (const auto found = at_most_one(keys)) return *found;
    fail_at(where(),
            fmt::format("{} has none of {}. Give one of them.", thing_, list_of(keys, "or")));
}

}  // namespace tyndall::cli
