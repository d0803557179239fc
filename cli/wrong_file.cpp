#include "cli/wrong_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <string_view>
#include <vector>

#include "cli/suggestion.h"
#include "mesh/input_error.h"

namespace tyndall::cli {
namespace {

namespace fs = std::filesystem;
using mesh::InputError;

std::string beginning(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::string text(65536, '\0');
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, in.gcount())));
    return text;
}

// Whether a line begins with it.
bool has_line(std::string_view text, std::string_view begin) {
    for (std::size_t at = 0; (at = text.find(begin, at)) != text.npos; ++at)
        if (at == 0 || text[at - 1] == '\n') return true;
    return false;
}

// Names of files with this ending in the folder of a path.
std::vector<std::string> neighbours(const fs::path& path, const std::string& extension) {
    std::vector<std::string> names;
    std::error_code ignored;
    const auto folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    for (const auto& entry : fs::directory_iterator(folder, ignored))
        if (entry.path().extension() == extension)
            names.push_back(path.has_parent_path() ? entry.path().string()
                                                   : entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

[[noreturn]] void fail_missing(const fs::path& path, const char* what, const std::string& else_do) {
    const auto names = neighbours(path, ".toml");
    const std::vector<std::string_view> views(names.begin(), names.end());
    const auto near = nearest(path.string(), views);
    throw InputError(
        fmt::format("{}: there is no such file. {}", path.string(),
                    near ? fmt::format("Did you mean {}?", *near)
                         : fmt::format("Correct the path of the {}{}.", what, else_do)));
}

// `is`: "a solution, not a scene".
[[noreturn]] void fail_kind(const fs::path& path, const char* is, const std::string& command) {
    throw InputError(fmt::format("{} is {}. It goes with: tyndall {}", path.string(), is, command));
}

std::string stem(const fs::path& path) {
    return path.stem().string();
}

}  // namespace

FileKind kind_of(const fs::path& path) {
    std::error_code error;
    const auto status = fs::status(path, error);
    if (!fs::exists(status)) return FileKind::missing;
    if (fs::is_directory(status)) return FileKind::folder;
    if (!fs::is_regular_file(status)) return FileKind::other;  // a pipe is read once
    const auto text = beginning(path);
    using namespace std::string_view_literals;
    if (text.starts_with("\x89HDF\r\n"sv)) return FileKind::solution;
    for (const auto magic : {"\x89PNG"sv, "\x76\x2f\x31\x01"sv, "PF\n"sv, "Pf\n"sv})
        if (text.starts_with(magic)) return FileKind::picture;
    const bool axes =
        has_line(text, "[axes]") || has_line(text, "[[axes]]") || has_line(text, "axes");
    const bool study = axes && has_line(text, "scene");
    if (study) return FileKind::study;
    const bool scene = has_line(text, "[[surface]]") || has_line(text, "surface") ||
                       has_line(text, "[[material]]") || has_line(text, "format");
    return scene ? FileKind::scene : FileKind::other;
}

void require_scene(const fs::path& path) {
    switch (kind_of(path)) {
        case FileKind::missing:
            fail_missing(path, "scene", ", or write one: tyndall new room -o room.toml");
        case FileKind::folder: {
            const auto scenes = neighbours(path / "", ".toml");
            throw InputError(fmt::format(
                "{}: this is a folder. Give a scene file{}.", path.string(),
                scenes.empty() ? std::string(" in it") : ", such as " + scenes.front()));
        }
        case FileKind::study:
            fail_kind(path, "a study, not a scene",
                      fmt::format("study {} -o {}/", path.string(), stem(path)));
        case FileKind::solution:
            fail_kind(path, "a solution, not a scene",
                      fmt::format("view {}, or: tyndall render {} -o image.png", path.string(),
                                  path.string()));
        case FileKind::picture:
            fail_kind(path, "a picture, not a scene",
                      fmt::format("compare {} REFERENCE", path.string()));
        default:
            return;
    }
}

void require_study(const fs::path& path) {
    switch (kind_of(path)) {
        case FileKind::missing:
            fail_missing(path, "study", "");
        case FileKind::scene:
            fail_kind(path, "a scene, not a study",
                      fmt::format("run {} -o {}/", path.string(), stem(path)));
        default:
            return;
    }
}

void require_solution(const fs::path& path) {
    switch (kind_of(path)) {
        case FileKind::scene:
            throw InputError(fmt::format(
                "{0} is a scene, not a solution. Solve it first: tyndall run {0} -o {1}/",
                path.string(), stem(path)));
        case FileKind::study:
            fail_kind(path, "a study, not a solution",
                      fmt::format("study {} -o {}/", path.string(), stem(path)));
        case FileKind::picture:
            throw InputError(
                fmt::format("{} is a picture, not a solution. Give the folder of the run, or its "
                            "solution.vtkhdf.",
                            path.string()));
        default:
            return;
    }
}

}  // namespace tyndall::cli
