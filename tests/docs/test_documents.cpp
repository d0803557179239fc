// The documents say what the program does: their scenes can be read, their reference is complete.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "cli/commands.h"
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

// Lines of code blocks that are commands, without what a shell makes of their ends.
std::vector<std::string> commands_in(const std::string& document) {
    std::istringstream in(document);
    std::vector<std::string> commands;
    for (std::string line; std::getline(in, line);) {
        const std::string indented = "    ", program = "tyndall ";
        if (line.rfind(indented, 0) != 0) continue;
        auto command = line.substr(indented.size());
        if (command.rfind("build/release/bin/", 0) == 0) command.erase(0, 18);
        if (command.rfind(program + "help", 0) == 0) continue;  // no command that is parsed
        if (command.rfind(program, 0) == 0) commands.push_back(command.substr(program.size()));
    }
    return commands;
}

// As a shell parts them: quotes, a comment behind, another command behind.
std::vector<std::string> words_of(const std::string& line) {
    std::vector<std::string> words;
    std::string word;
    char quote = 0;
    bool any = false;
    const auto end = [&] {
        if (any) words.push_back(word);
        word.clear();
        any = false;
    };
    for (std::size_t k = 0; k < line.size(); ++k) {
        const char c = line[k];
        if (quote != 0) {
            if (c == quote)
                quote = 0;
            else
                word += c;
        } else if (c == '\'' || c == '"') {
            quote = c;
            any = true;
        } else if (c == ' ') {
            end();
            // What stands behind two spaces is said, not typed.
            if (line.compare(k, 2, "  ") == 0 && !words.empty()) return words;
        } else if (c == '&' || c == '|' || c == '>' || c == '<' || c == '#' || c == ';' ||
                   c == '\\') {
            break;
        } else {
            word += c;
            any = true;
        }
    }
    end();
    return words;
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

TEST_CASE("the version is one: CMake's, the changelog's newest, the citation's, the program's") {
    const auto behind = [](const std::string& text, const std::string& begin) {
        const auto at = text.find(begin);
        REQUIRE(at != std::string::npos);
        const auto from = at + begin.size();
        return text.substr(from, text.find_first_not_of("0123456789.", from) - from);
    };
    const std::string version =
        behind(text_of(root / "CMakeLists.txt"), "project(Tyndall VERSION ");
    CHECK(std::count(version.begin(), version.end(), '.') == 2);
    CHECK(behind(text_of(root / "CHANGELOG.md"), "\n## ") == version);
    CHECK(behind(text_of(root / "CITATION.cff"), "\nversion: ") == version);
    tyndall::cli::Shell shell;
    CHECK(shell.description().version == version);
}

TEST_CASE("commands in the documents are understood") {
    std::size_t count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(root / "docs")) {
        if (entry.path().extension() != ".md") continue;
        const auto lines = commands_in(text_of(entry.path()));
        for (const auto& line : lines) {
            INFO(entry.path() << ": " << line);
            tyndall::cli::Shell shell;
            tyndall::cli::add_all_commands(shell);
            CHECK(shell.trouble(words_of(line)) == "");
            ++count;
        }
    }
    CHECK(count > 50);
}
