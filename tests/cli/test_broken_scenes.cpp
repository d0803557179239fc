// Every file in tests/broken must be refused with the message its first line names:
//   # expect: LINE:COLUMN part of the message
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "cli/scene_file.h"
#include "cli/scene_spectrum.h"
#include "mesh/input_error.h"
#include "support/catch.h"
#include "support/own_folder.h"

using namespace tyndall;
namespace fs = std::filesystem;

namespace {

struct Expected {
    std::string place, part;
};

Expected expectation(const fs::path& path) {
    std::ifstream stream(path);
    std::string line;
    std::getline(stream, line);
    const std::string mark = "# expect: ";
    REQUIRE(line.rfind(mark, 0) == 0);
    const auto space = line.find(' ', mark.size());
    return {line.substr(mark.size(), space - mark.size()), line.substr(space + 1)};
}

std::vector<fs::path> scenes_in(const fs::path& folder) {
    std::vector<fs::path> paths;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.path().extension() == ".toml") paths.push_back(entry.path());
    }
    std::sort(paths.begin(), paths.end());
    return paths;
}

std::string scene_message(const fs::path& path) {
    try {
        cli::read_scene_file(path);
    } catch (const mesh::InputError& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("Broken scenes are refused, with place, name and advice") {
    const auto paths = scenes_in(fs::path(TYNDALL_SOURCE_DIR) / "tests/broken");
    CHECK(paths.size() >= 249);
    for (const fs::path& path : paths) {
        const Expected expected = expectation(path);
        const std::string message = scene_message(path);
        INFO(path.filename().string() << ": " << message);
        CHECK(message.rfind(path.string() + ":" + expected.place + ": ", 0) == 0);
        CHECK(message.find(expected.part) != std::string::npos);
        CHECK(message.find('\n') == std::string::npos);
    }
}

TEST_CASE("Broken files of grey gases are refused, with place and advice") {
    const auto paths = scenes_in(fs::path(TYNDALL_SOURCE_DIR) / "tests/broken/gases");
    CHECK(paths.size() >= 10);
    for (const fs::path& path : paths) {
        const Expected expected = expectation(path);
        std::string message;
        try {
            cli::read_grey_gases(path);
        } catch (const mesh::InputError& error) {
            message = error.what();
        }
        INFO(path.filename().string() << ": " << message);
        CHECK(message.rfind(path.string() + ":" + expected.place + ": ", 0) == 0);
        CHECK(message.find(expected.part) != std::string::npos);
    }
}

TEST_CASE("Scenes that only the mesh shows to be broken are read") {
    for (const auto& path : scenes_in(fs::path(TYNDALL_SOURCE_DIR) / "tests/broken/enclosure")) {
        INFO(path.filename().string());
        CHECK(scene_message(path) == "");
    }
}

TEST_CASE("A scene that is missing, a directory, or cut short anywhere is refused") {
    const fs::path folder = fs::path(TYNDALL_SOURCE_DIR) / "tests/broken";
    CHECK(scene_message(folder / "no_such.toml").find("there is no such file") !=
          std::string::npos);
    CHECK(scene_message(folder).find("this is a directory") != std::string::npos);

    // No prefix of a scene may do other than read or throw InputError.
    std::ifstream stream(fs::path(TYNDALL_SOURCE_DIR) / "examples/scenes/window_shafts.toml");
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    REQUIRE(text.size() > 1000);
    const fs::path path = test::own_folder() / "cut_short.toml";
    for (std::size_t size = 0; size < text.size(); size += 13) {
        std::ofstream(path, std::ios::binary) << text.substr(0, size);
        CHECK_NOTHROW(scene_message(path));
    }
    fs::remove(path);
}
