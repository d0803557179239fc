#include "cli/names.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/suggestion.h"
#include "cli/toml_text.h"

namespace tyndall::cli {

std::string name_trouble(const std::string& name) {
    if (name.empty()) return "is empty";
    if (name.size() > 200) return "is longer than 200 bytes";
    if (name.front() == ' ' || name.back() == ' ') return "begins or ends with a space";
    if (name.back() == '-') return "ends with '-', which names the back side";
    if (name == "outside") return "is what lies beyond the scene";
    for (const char c : name) {
        if (c == '+') return "holds '+', which names the front side";
        if (c == '.') return "holds '.', which parts a surface's name from its face's";
        if (c == '=' || c == ',' || c == '"') return fmt::format("holds '{}'", c);
        if (static_cast<unsigned char>(c) < 0x20) return "holds a control character";
    }
    return "";
}

std::string Names::take(const toml::table& table) {
    const toml::node* node = table.get("name");
    if (!node) {
        fail_at(place_of(table.source()),
                fmt::format("this {} has no name. Add name = \"…\".", kind_));
    }
    const std::string place = place_of(node->source());
    const auto name = node->value_exact<std::string>();
    if (!name) {
        fail_at(place,
                fmt::format("name of this {} is {} ({}); a string is expected. Put it in quotes.",
                            kind_, type_of(*node), text_of(*node)));
    }
    const std::string trouble = name_trouble(*name);
    if (!trouble.empty()) {
        fail_at(place, fmt::format("the name \"{}\" of this {} {}. Give another name.", *name,
                                   kind_, trouble));
    }
    take(*name, place);
    return *name;
}

void Names::take(const std::string& name, const std::string& place) {
    const auto [other, is_new] = places_.emplace(name, place);
    if (!is_new) {
        fail_at(place,
                fmt::format("a {} named \"{}\" is there already, at {}. Give every {} a name of "
                            "its own.",
                            kind_, name, other->second, kind_));
    }
    order_.push_back(name);
}

std::size_t Names::find(const TableReader& reader, std::string_view key) const {
    const std::string name = reader.text(key);
    const auto found = std::find(order_.begin(), order_.end(), name);
    if (found == order_.end()) {
        const std::string advice =
            order_.empty() ? fmt::format("The scene has no {}.", kind_) : suggest(name, order_);
        reader.fail(key, fmt::format("{} of {} names the {} \"{}\", which there is not. {}", key,
                                     reader.thing(), kind_, name, advice));
    }
    return static_cast<std::size_t>(found - order_.begin());
}

}  // namespace tyndall::cli
