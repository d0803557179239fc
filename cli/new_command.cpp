#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/scene_templates.h"
#include "mesh/file_bytes.h"
#include "mesh/input_error.h"

namespace tyndall::cli {
namespace {

namespace fs = std::filesystem;

struct NewOptions {
    std::string name{scene_templates().front().name}, out;
    bool list = false, force = false;
};

void list_templates(const CommonFlags& flags) {
    auto json = nlohmann::ordered_json::array();
    std::string text;
    for (const auto& scene : scene_templates()) {
        json.push_back({{"name", scene.name}, {"purpose", scene.purpose}});
        text += fmt::format("{:<10}{}\n", scene.name, scene.purpose);
    }
    write_output(flags.json ? json.dump(2) + "\n" : text);
}

// Nothing of somebody's is lost by a name that was taken already.
void check_free(const fs::path& path, bool force) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored))
        throw mesh::InputError(fmt::format("'{}' is a folder. Give the scene file a name: -o {}",
                                           path.string(), (path / "room.toml").string()));
    if (!force && fs::exists(fs::symlink_status(path, ignored)))
        throw mesh::InputError(
            fmt::format("'{}' is there already. Take another name, or --force to write over it.",
                        path.string()));
}

// In quotes where a shell would take it apart.
std::string quoted(const std::string& path) {
    const bool plain = path.find_first_of(" \t'\"\\$&;|<>()*?[]#~!`") == path.npos;
    return plain ? path : "'" + path + "'";
}

// As it stands between a TOML string's quotes.
std::string in_toml(std::string text) {
    for (std::size_t at = 0; (at = text.find_first_of("\\\"", at)) != text.npos; at += 2)
        text.insert(at, 1, '\\');
    return text;
}

fs::path scene_path(const NewOptions& options, const SceneTemplate& scene) {
    const fs::path path(options.out.empty() ? std::string(scene.name) + ".toml" : options.out);
    for (const char c : options.out)
        if (static_cast<unsigned char>(c) < 0x20)
            throw mesh::InputError("--output holds a control character. Take another name.");
    if (path.extension() != ".toml")
        throw mesh::InputError(
            fmt::format("'{}': scene files are TOML. Name a .toml file, as in -o {}.toml.",
                        path.string(), path.stem().string()));
    return path;
}

std::string what_next(const SceneTemplate& scene, const fs::path& path) {
    const auto file = quoted(path.string());
    return fmt::format("next     tyndall check {}\n         tyndall {} {} -o out/\n", file,
                       scene.name == "furnace" ? "solve" : "run", file);
}

int make_scene(const NewOptions& options, const CommonFlags& flags) {
    if (options.list) {
        list_templates(flags);
        return 0;
    }
    const auto& scene = scene_template(options.name);
    const auto path = scene_path(options, scene);
    auto model = path;
    model.replace_extension(".obj");
    const bool with_model = !scene.model.empty();
    check_free(path, options.force);
    if (with_model) check_free(model, options.force);
    if (path.has_parent_path()) fs::create_directories(path.parent_path());
    if (with_model) mesh::write_file(model, std::string(template_text(scene.model)));
    mesh::write_file(
        path, scene_of_template(scene, quoted(path.string()), in_toml(model.filename().string())));
    if (flags.json) {
        nlohmann::ordered_json json{{"template", scene.name}, {"file", path.string()}};
        if (with_model) json["model"] = model.string();
        write_output(json.dump(2) + "\n");
    } else if (!flags.quiet) {
        auto text = fmt::format("wrote    {}\n", path.string());
        if (with_model) text += fmt::format("wrote    {}\n", model.string());
        write_output(text + what_next(scene, path));
    }
    return 0;
}

}  // namespace

void add_new_command(Shell& shell) {
    const auto options = std::make_shared<NewOptions>();
    auto command = shell.add_command(
        "new", "Write a scene file to begin with, with its units in comments",
        R"(  tyndall new room -o room.toml
  tyndall new --list                           what templates there are
  tyndall new model -o fog/hall.toml           and the model fog/hall.obj)",
        [options](const CommonFlags& flags) { return make_scene(*options, flags); });
    std::vector<std::string> names;
    for (const auto& scene : scene_templates()) names.emplace_back(scene.name);
    command.option("TEMPLATE", options->name, "Which one; room if not given").word_of(names);
    command.option("-o,--output", options->out, "Scene file; TEMPLATE.toml if not given")
        .file({"toml"});
    command.flag("--list", options->list, "Say what templates there are, and write nothing");
    command.flag("--force", options->force, "Write over a file that is there");
}

}  // namespace tyndall::cli
