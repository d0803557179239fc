#include "cli/toml_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>
#include <tuple>
#include <vector>

#include "cli/toml_reader.h"

namespace tyndall::cli {
namespace {

std::string quoted_text(std::string_view text) {
    std::string result = "\"";
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            result += '\\';
            result += c;
        } else if (code < 0x20 || code == 0x7F) {
            result += fmt::format("\\u{:04X}", code);
        } else {
            result += c;
        }
    }
    return result + "\"";
}

std::string key_text(std::string_view key) {
    const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '_' || c == '-';
    });
    return bare ? std::string(key) : quoted_text(key);
}

std::string number_text(double value) {
    if (std::isnan(value)) return "nan";
    if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
    std::string text = fmt::format("{}", value);  // the shortest that reads back the same
    if (text.find_first_of(".e") == text.npos) text += ".0";
    return text;
}

struct Entry {
    std::string_view key;
    const toml::node* node;
    std::tuple<bool, toml::source_index, toml::source_index> order;
};

// In the order of the file; what was set from outside goes last.
std::vector<Entry> entries(const toml::table& table) {
    std::vector<Entry> result;
    for (const auto& [key, node] : table) {
        const auto& source = key.source();
        const bool from_outside = !source.path || source.path->starts_with("--set ");
        result.push_back(
            {key.str(), &node, {from_outside, source.begin.line, source.begin.column}});
    }
    std::stable_sort(result.begin(), result.end(),
                     [](const Entry& a, const Entry& b) { return a.order < b.order; });
    return result;
}

std::string inline_text(const toml::node& node) {
    std::string text;
    if (const auto* table = node.as_table()) {
        for (const Entry& entry : entries(*table)) {
            text += text.empty() ? "{ " : ", ";
            text += key_text(entry.key) + " = " + inline_text(*entry.node);
        }
        return text.empty() ? "{}" : text + " }";
    }
    if (const auto* array = node.as_array()) {
        for (const toml::node& element : *array) {
            text += (text.empty() ? "" : ", ") + inline_text(element);
        }
        return "[" + text + "]";
    }
    if (const auto* value = node.as_string()) return quoted_text(value->get());
    if (const auto* value = node.as_floating_point()) return number_text(value->get());
    std::ostringstream stream;  // integers, booleans, dates
    node.visit([&](const auto& value) {
        using Node = std::remove_cvref_t<decltype(value)>;
        if constexpr (!std::is_same_v<Node, toml::table> && !std::is_same_v<Node, toml::array>) {
            stream << value;
        }
    });
    return stream.str();
}

bool is_section(const toml::node& node) {
    if (const auto* table = node.as_table()) return !table->is_inline();
    const auto* array = node.as_array();
    if (!array || array->empty()) return false;
    return std::all_of(array->begin(), array->end(), [](const toml::node& element) {
        return element.is_table() && !element.as_table()->is_inline();
    });
}

// The plain keys of a table, then its sections under their headers.
void print(const toml::table& table, const std::string& path, std::string& text) {
    const auto all = entries(table);
    for (const Entry& entry : all) {
        if (is_section(*entry.node)) continue;
        text += key_text(entry.key) + " = " + inline_text(*entry.node) + "\n";
    }
    for (const Entry& entry : all) {
        if (!is_section(*entry.node)) continue;
        const std::string name =
            path.empty() ? key_text(entry.key) : path + "." + key_text(entry.key);
        if (const auto* section = entry.node->as_table()) {
            text += "\n[" + name + "]\n";
            print(*section, name, text);
            continue;
        }
        for (const toml::node& element : *entry.node->as_array()) {
            text += "\n[[" + name + "]]\n";
            print(*element.as_table(), name, text);
        }
    }
}

std::string read_text(const std::filesystem::path& path, const std::string& thing) {
    const std::string name = path.string();
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (status.type() == std::filesystem::file_type::not_found)
        fail_at(name, fmt::format("there is no such file. Correct the path of the {}.", thing));
    if (std::filesystem::is_directory(status))
        fail_at(name, fmt::format("this is a directory. Give a {} file in it.", thing));
    std::ifstream stream(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    if (!stream.is_open() || stream.bad()) fail_at(name, "cannot be read. Check its permissions.");
    return text;
}

}  // namespace

toml::table parse_toml_file(const std::filesystem::path& path, const std::string& thing) {
    const std::string text = read_text(path, thing);
    try {
        return toml::parse(text, path.string());
    } catch (const toml::parse_error& error) {
        fail_at(place_of(error.source()),
                fmt::format("this is not valid TOML: {}. Correct it.", error.description()));
    }
}

std::string toml_text(const toml::table& root) {
    std::string text;
    print(root, "", text);
    return text;
}

std::string whole_text_of(const toml::node& node) {
    return inline_text(node);
}

std::string text_of(const toml::node& node) {
    std::string text = inline_text(node);
    constexpr std::size_t longest = 60;
    if (text.size() > longest) {
        std::size_t end = longest;  // never inside a UTF-8 sequence
        while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
        text = text.substr(0, end) + "…";
    }
    return text;
}

}  // namespace tyndall::cli
