#include "cli/overrides.h"

#include <fmt/format.h>

#include <vector>

#include "cli/suggestion.h"
#include "cli/toml_reader.h"

namespace tyndall::cli {
namespace {

struct Override {
    std::string place;              // "--set key=value"
    std::vector<std::string> path;  // of keys
    std::string value;
};

// Keys are parted by dots, all of it by the first '='; neither counts within quotes.
Override split(const std::string& text) {
    Override result{"--set " + text, {""}, {}};
    char quote = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quote != 0) {
            if (c == quote)
                quote = 0;
            else
                result.path.back() += c;
        } else if (c == '"' || c == '\'') {
            quote = c;
        } else if (c == '=') {
            result.value = text.substr(i + 1);
            for (std::string& key : result.path) {
                while (key.ends_with(' ')) key.pop_back();
                while (key.starts_with(' ')) key.erase(0, 1);
                if (key.empty()) {
                    fail_at(result.place,
                            "a key is empty. Write --set key=value, such as "
                            "--set solve.error=0.003.");
                }
            }
            return result;
        } else if (c == '.') {
            result.path.emplace_back();
        } else {
            result.path.back() += c;
        }
    }
    fail_at(result.place,
            "there is no '='. Write --set key=value, such as --set solve.error=0.003.");
}

// A table {"v": value} whose nodes carry the override as their place.
toml::table parse_value(const Override& override) {
    const std::string& value = override.value;
    const auto first = value.find_first_not_of(" \t");
    if (first == value.npos) return toml::parse("v = \"\"", override.place);
    std::string reason;
    try {
        toml::table parsed = toml::parse("v = " + value, override.place);
        if (parsed.size() == 1) return parsed;
        reason = "it holds more than one line";
    } catch (const toml::parse_error& error) {
        reason = error.description();
    }
    const bool structured = std::string_view("[{\"'").find(value[first]) != std::string_view::npos;
    if (structured || value.find('\n') != value.npos) {
        fail_at(override.place,
                fmt::format("the value {} is not valid TOML: {}. Give a number, a string, "
                            "an array such as [0, 0, 1].",
                            value, reason));
    }
    toml::table parsed = toml::parse("v = \"\"", override.place);
    parsed.get("v")->ref<std::string>() = value.substr(first);
    return parsed;
}

toml::key key_of(const std::string& name, const Override& override) {
    toml::table parsed = toml::parse("v = 0", override.place);  // for its source
    return toml::key(name, parsed.begin()->first.source());
}

toml::table& element_named(toml::array& array, const std::string& name, const std::string& kind,
                           const std::string& place) {
    std::vector<std::string> names;
    for (toml::node& element : array) {
        const toml::table* table = element.as_table();
        const auto found = table ? (*table)["name"].value<std::string>() : std::nullopt;
        if (!found) continue;
        if (*found == name) return *element.as_table();
        names.push_back(*found);
    }
    const std::vector<std::string_view> views(names.begin(), names.end());
    fail_at(place, fmt::format("there is no {} named \"{}\". {}", kind, name,
                               names.empty() ? fmt::format("The file names no {}.", kind)
                                             : fmt::format("There is: {}.", list_of(views))));
}

bool is_named_kind(const std::string& key) {
    return key == "material" || key == "surface" || key == "medium" || key == "light" ||
           key == "camera";
}

// The table under `key` of `table`, made if it is missing.
toml::node& child(toml::table& table, const std::string& key, const Override& override) {
    if (toml::node* found = table.get(key)) return *found;
    toml::table made = toml::parse("v = {}", override.place);
    table.insert_or_assign(key_of(key, override), std::move(*made.get_as<toml::table>("v")));
    table.get(key)->as_table()->is_inline(false);
    return *table.get(key);
}

toml::table& descend(toml::table& root, const Override& override) {
    toml::table* table = &root;
    for (std::size_t i = 0; i + 1 < override.path.size(); ++i) {
        const std::string& key = override.path[i];
        if (i == 0 && is_named_kind(key) && !root.contains(key)) {
            fail_at(override.place, fmt::format("the file has no {}.", key));
        }
        toml::node& node = child(*table, key, override);
        if (toml::array* array = node.as_array()) {
            const bool array_of_tables = !array->empty() && array->front().is_table();
            if (i + 2 >= override.path.size() || !array_of_tables) {
                fail_at(
                    override.place,
                    fmt::format(
                        "{} is an array{}.", key,
                        array_of_tables
                            ? fmt::format(
                                  ". Name one of its elements and a key of it: {0}.NAME.KEY=…", key)
                            : fmt::format(". Give all of it: {}=[…]", key)));
            }
            table = &element_named(*array, override.path[++i], key, override.place);
        } else if (node.is_table()) {
            table = node.as_table();
        } else {
            fail_at(override.place, fmt::format("{} is {}, which has no keys. Leave out \".{}\".",
                                                key, type_of(node), override.path[i + 1]));
        }
    }
    return *table;
}

}  // namespace

void apply_override(toml::table& root, const std::string& text) {
    const Override override = split(text);
    toml::table parsed = parse_value(override);
    toml::table& table = descend(root, override);
    const std::string& key = override.path.back();
    parsed.get("v")->visit([&](auto& value) {
        // Moving keeps the node's source; copying would lose it.
        table.insert_or_assign(key_of(key, override), std::move(value));
    });
}

}  // namespace tyndall::cli
