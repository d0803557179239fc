// The documents say what the program does: their scenes can be read, their reference is complete.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "cli/scene_file.h"
#include "cli/study_file.h"
#include "support/catch.h"

namespace {

namespace fs = std::filesystem;
const fs::path root = TYNDALL_SOURCE_DIR;
const fs::path scratch = fs::path(TYNDALL_BINARY_DIR) / "documents";

std::string text_of(const fs::path& file) {
    std::ifstream in(file);
    REQUIRE(in);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

void write(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
}

// The ```toml blocks of a document that are whole scenes: those that say their format.
std::vector<std::string> scenes_in(const std::string& document) {
    const std::string begin = "```toml\n";
    std::vector<std::string> scenes;
    for (auto at = document.find(begin); at != std::string::npos; at = document.find(begin, at)) {
        at += begin.size();
        const std::string block = document.substr(at, document.find("```", at) - at);
        if (block.rfind("format", 0) == 0) scenes.push_back(block);
    }
    return scenes;
}

}  // namespace

// TYNDALL_UPDATE_DOCUMENTS=1 build/release/bin/tests_docs writes the references anew.
static void check_reference(const char* guide_name, const std::string& reference) {
    const fs::path guide = root / guide_name;
    const std::string begin = "<!-- begin: every key, written by tests/docs -->\n\n";
    std::string document = text_of(guide);
    const auto at = document.find(begin);
    REQUIRE(at != std::string::npos);
    document.erase(at + begin.size());
    document += reference;
    if (std::getenv("TYNDALL_UPDATE_DOCUMENTS")) write(guide, document);
    INFO("Run TYNDALL_UPDATE_DOCUMENTS=1 build/release/bin/tests_docs, and read what it changed.");
    CHECK(document == text_of(guide));
}

TEST_CASE("the guide's references list every key, as the program knows them") {
    check_reference("docs/guide/02-scene-file.md", tyndall::cli::scene_file_reference());
    check_reference("docs/guide/06-studies.md", tyndall::cli::study_file_reference());
}

TEST_CASE("whole scenes in the documents can be read") {
    std::size_t count = 0;
    for (const auto* document :
         {"README.md", "docs/guide/02-scene-file.md", "docs/guide/03-light-shafts.md"}) {
        for (const auto& scene : scenes_in(text_of(root / document))) {
            const fs::path file = scratch / ("scene_" + std::to_string(count++) + ".toml");
            write(file, scene);
            INFO(document << "\n" << scene);
            CHECK_NOTHROW(tyndall::cli::read_scene_file(file));
        }
    }
    CHECK(count >= 2);  // the README's and the guide's first
}

TEST_CASE("the guide's C++ program is the one that tests/install builds and runs") {
    const std::string program = text_of(root / "tests/install/user.cpp");
    CHECK(text_of(root / "docs/guide/05-cpp-api.md").find(program) != std::string::npos);
}

TEST_CASE("every equation of the theory is listed with its files") {
    const auto numbers_in = [](const std::string& text, const std::regex& pattern) {
        std::set<int> numbers;
        for (std::sregex_iterator at(text.begin(), text.end(), pattern), end; at != end; ++at) {
            const int first = std::stoi((*at)[1]);
            const int last = (*at)[2].matched ? std::stoi((*at)[2]) : first;
            for (int n = first; n <= last; ++n) numbers.insert(n);
        }
        return numbers;
    };
    const auto numbered =
        numbers_in(text_of(root / "docs/theory.md"), std::regex(R"(\\tag\{(\d+)(\d{9})?\})"));
    // "| (8 – 10) |", "| (2, 3) |"
    const auto listed = numbers_in(text_of(root / "docs/equations.md"),
                                   std::regex(R"(\| \((\d+)(?:(?: – |, )(\d+))?\) \|)"));
    CHECK(numbered.size() > 60);
    CHECK(numbered == listed);
}
