// Scenes that read well and cannot be solved: what is wrong shows when they are meshed.
//   # expect: part of the message
#include <algorithm>
#include <filesystem>
#include <fstream>

#include "cli/scene_file.h"
#include "mesh/input_error.h"
#include "radiosity/enclosure.h"
#include "support/catch.h"

using namespace tyndall;

TEST_CASE("Scenes that cannot be meshed or solved are refused, with place and name") {
    std::size_t count = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(TYNDALL_SOURCE_DIR "/tests/broken/enclosure")) {
        if (entry.path().extension() != ".toml") continue;
        ++count;
        std::ifstream stream(entry.path());
        std::string expected;
        std::getline(stream, expected);
        expected.erase(0, std::string("# expect: ").size());
        std::string message;
        try {
            radiosity::make_enclosure(cli::read_scene_file(entry.path()).scene);
        } catch (const mesh::InputError& error) {
            message = error.what();
        }
        INFO(entry.path().filename() << ": \"" << message << "\", expected \"" << expected << "\"");
        CHECK(message.find(expected) != std::string::npos);
        // The place: this file, with a line.
        CHECK(message.find(entry.path().filename().string() + ":") != std::string::npos);
    }
    CHECK(count >= 12);
}
