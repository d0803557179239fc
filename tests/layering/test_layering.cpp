// The house's floor plan, read from the sources: includes and links run one way, and every
// third-party library stays in its room.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "support/catch.h"

namespace {

namespace fs = std::filesystem;

const std::vector<std::string> house{"mesh",    "radiosity", "render", "view",
                                     "exports", "cli"};  // who comes first may not know who follows

struct Line {
    fs::path file;  // relative to the project
    std::size_t number;
    std::string text;
};

std::size_t rank(const std::string& folder) {
    return static_cast<std::size_t>(std::find(house.begin(), house.end(), folder) - house.begin());
}

bool is_header(const Line& line) {
    return line.file.extension() == ".h";
}

// A program's main file (tetgen_main.cpp) is no library: it may print.
bool is_main(const Line& line) {
    return line.file.stem().string().ends_with("_main");
}

std::string place(const Line& line) {
    return line.file.string() + ":" + std::to_string(line.number) + ": " + line.text;
}

void read_lines(const fs::path& file, const fs::path& root, std::vector<Line>& lines) {
    std::ifstream in(file);
    std::string text;
    const fs::path name = file.lexically_relative(root);
    for (std::size_t number = 1; std::getline(in, text); ++number) {
        lines.push_back({name, number, text});
    }
}

// Every line of the sources in `folder`, matched by `pattern`.
std::vector<Line> matching(const std::string& folder, const std::regex& pattern) {
    const fs::path root = TYNDALL_SOURCE_DIR;
    std::vector<Line> lines;
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
        const auto extension = entry.path().extension();
        if (extension == ".h" || extension == ".cpp") {
            read_lines(entry.path(), root, lines);
        }
    }
    REQUIRE(!lines.empty());
    std::erase_if(lines, [&](const Line& line) { return !std::regex_search(line.text, pattern); });
    return lines;
}

std::string captured(const Line& line, const std::regex& pattern) {
    std::smatch match;
    std::regex_search(line.text, match, pattern);
    return match[1];
}

// A third-party library, told by what its includes begin with, and the folders it lives in.
struct Room {
    std::string name;
    std::string includes;
    std::vector<std::string> folders;
};

const std::vector<Room> rooms{
    {"CGAL", "<CGAL/", {"mesh"}},
    {"TetGen", "<tetgen", {"mesh"}},
    {"OpenMesh", "<OpenMesh/", {"mesh"}},
    {"Eigen", "<Eigen/", {"radiosity"}},
    {"Embree", "<embree", {"radiosity"}},
    {"HDF5", "<(hdf5|H5)", {"radiosity"}},
    {"OpenEXR", "<(OpenEXR/)?Imf", {"render"}},
    {"libpng", "<png\\.h", {"render"}},
    {"zlib", "<zlib", {"view", "exports"}},
    {"toml++", "<toml", {"cli"}},
    {"CLI11", "<CLI/", {"cli"}},
    {"muParser", "<muParser", {"cli"}},
};

// Libraries that no header includes: they would cost every file seconds, and every user of the
// installed package a dependency at compile time.
const std::vector<std::string> heavy{"CGAL", "TetGen",  "OpenMesh", "Eigen", "Embree",
                                     "HDF5", "OpenEXR", "libpng",   "zlib"};

}  // namespace

TEST_CASE("includes run one way: mesh <- radiosity <- render <- view <- exports <- cli") {
    const std::regex own_include(R"re(^\s*#\s*include\s*"([^"/]*)/?[^"]*")re");
    for (const auto& folder : house) {
        for (const auto& line : matching(folder, own_include)) {
            INFO(place(line));
            const auto included = captured(line, own_include);
            // "walk.h" without its folder, or a folder outside the house, has rank 6.
            CHECK(rank(included) <= rank(folder));
        }
    }
}

TEST_CASE("links run one way") {
    const std::regex link(R"(Tyndall::([a-z]+))");
    for (const auto& folder : house) {
        const fs::path root = TYNDALL_SOURCE_DIR;
        std::vector<Line> lines;
        read_lines(root / folder / "CMakeLists.txt", root, lines);
        REQUIRE(!lines.empty());
        for (const auto& line : lines) {
            if (std::regex_search(line.text, link)) {
                INFO(place(line));
                CHECK(rank(captured(line, link)) < rank(folder));
            }
        }
    }
}

TEST_CASE("examples and tests of the libraries do not reach into the command") {
    const std::regex cli_include(R"re(^\s*#\s*include\s*"cli/)re");
    for (const auto* folder : {"tests/mesh", "tests/radiosity", "tests/render", "tests/view",
                               "tests/exports", "examples"}) {
        if (!fs::exists(fs::path(TYNDALL_SOURCE_DIR) / folder)) {
            continue;
        }
        for (const auto& entry : fs::directory_iterator(fs::path(TYNDALL_SOURCE_DIR) / folder)) {
            std::vector<Line> lines;
            read_lines(entry.path(), TYNDALL_SOURCE_DIR, lines);
            for (const auto& line : lines) {
                INFO(place(line));
                CHECK_FALSE(std::regex_search(line.text, cli_include));
            }
        }
    }
}

TEST_CASE("third-party headers stay in their rooms") {
    for (const auto& room : rooms) {
        const std::regex include(R"(^\s*#\s*include\s*)" + room.includes);
        for (const auto& folder : house) {
            for (const auto& line : matching(folder, include)) {
                INFO(room.name << " belongs in " << room.folders[0] << "/\n" << place(line));
                CHECK(std::ranges::count(room.folders, folder) == 1);
            }
        }
    }
}

TEST_CASE("no header includes a heavy library") {
    for (const auto& room : rooms) {
        if (std::find(heavy.begin(), heavy.end(), room.name) == heavy.end()) {
            continue;
        }
        const std::regex include(R"(^\s*#\s*include\s*)" + room.includes);
        for (const auto& folder : room.folders) {
            for (const auto& line : matching(folder, include)) {
                INFO(place(line));
                CHECK_FALSE(is_header(line));
            }
        }
    }
}

TEST_CASE("a library never prints, exits or starts threads of its own") {
    const std::regex forbidden(
        R"(\bstd::(cout|cerr|clog|printf|puts|exit|thread|jthread|async)\b|\bfmt::print\b|#\s*pragma\s+omp)");
    for (const auto* folder : {"mesh", "radiosity", "render", "view", "exports"}) {
        for (const auto& line : matching(folder, forbidden)) {
            // hardware_concurrency only asks; it starts nothing.
            const bool asks = line.text.find("thread::hardware_concurrency") != std::string::npos;
            // OpenMesh prints by itself; it is told not to.
            const bool silences = line.text.find("omerr()") != std::string::npos ||
                                  line.text.find("omlog()") != std::string::npos;
            INFO(place(line));
            CHECK((is_main(line) || asks || silences));
        }
    }
}
