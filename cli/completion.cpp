#include "cli/completion.h"

#include "cli/scene_keys.h"
#include "cli/settings.h"
#include "mesh/file_bytes.h"

namespace tyndall::cli {
namespace {

void add(std::vector<std::string>& keys, const std::string& before, const KeyTable& table) {
    for (const Key& key : table.keys)
        if (key.name != "name") keys.push_back(before + std::string(key.name));
}

// In quotes where a dot or a space would part it, as --set reads it.
std::string key_part(const std::string& name) {
    return name.find_first_of(". ") == name.npos ? name : "\"" + name + "\"";
}

// Of one array of named tables.
void add_named(std::vector<std::string>& keys, const toml::table& scene, const char* kind,
               const KeyTable& table) {
    const toml::array* elements = scene[kind].as_array();
    if (!elements) return;
    for (const toml::node& element : *elements) {
        const toml::table* one = element.as_table();
        const auto name = one ? (*one)["name"].value<std::string>() : std::nullopt;
        if (!name) continue;
        const std::string before = std::string(kind) + "." + key_part(*name) + ".";
        if (&table != &keys::light()) {
            add(keys, before, table);
            continue;
        }
        if (one->contains("sun")) add(keys, before + "sun.", keys::sun());
        if (one->contains("point")) add(keys, before + "point.", keys::point());
        if (one->contains("spot")) add(keys, before + "spot.", keys::spot());
    }
}

toml::table table_or_nothing(const std::filesystem::path& scene) {
    try {
        return toml::parse(mesh::read_file(scene));
    } catch (const std::exception&) {
        return {};
    }
}

}  // namespace

std::vector<std::string> settable_keys(const std::filesystem::path& scene) {
    std::vector<std::string> result{"title", "bands", "band_edges", "grey_gases"};
    add(result, "solve.", solve_keys());
    add(result, "render.", render_keys());
    add(result, "environment.", keys::environment());
    if (scene.empty()) return result;
    const toml::table table = table_or_nothing(scene);
    add_named(result, table, "material", keys::material());
    add_named(result, table, "surface", keys::surface());
    add_named(result, table, "medium", keys::medium());
    add_named(result, table, "light", keys::light());
    add_named(result, table, "camera", keys::camera());
    return result;
}

bool scene_has_key(const std::string& key) {
    return keys::root().find(key) != nullptr;
}

SortedOptions sorted_options(const CommandDescription& command) {
    SortedOptions sorted;
    for (const auto& option : command.options) {
        auto& where = option.positional      ? sorted.places
                      : option.value.empty() ? sorted.switches
                                             : sorted.values;
        where.push_back(&option);
    }
    return sorted;
}

std::string in_quotes(const std::string& text) {
    std::string result = "'";
    for (const char c : text) {
        if (c == '\'')
            result += "'\\''";
        else
            result += c;
    }
    return result + "'";
}

}  // namespace tyndall::cli
