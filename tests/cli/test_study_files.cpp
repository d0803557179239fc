// Study files: what they say, and that broken ones are refused before anything runs. Every file in
// tests/broken/study must be refused with the message its first line names:
//   # expect: LINE:COLUMN part of the message
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "cli/study_matrix.h"
#include "mesh/input_error.h"
#include "support/catch.h"
#include "support/own_folder.h"

using namespace tyndall;
namespace fs = std::filesystem;

namespace {

const fs::path source = TYNDALL_SOURCE_DIR;

// All that `tyndall study` checks before its first run.
std::string study_message(const fs::path& path) {
    try {
        const auto study = cli::read_study_file(path);
        for (const auto& run : cli::expand(study, {})) cli::scene_with(study, run.overrides);
    } catch (const mesh::InputError& error) {
        return error.what();
    }
    return "";
}

fs::path written(const std::string& text) {
    const fs::path path = test::own_folder() / "study_of_the_test.toml";
    std::ofstream(path) << "scene = \"" << (source / "examples/scenes/window_shafts.toml").string()
                        << "\"\n"
                        << text;
    return path;
}

std::vector<std::string> slugs(const cli::Study& study) {
    std::vector<std::string> result;
    for (const auto& run : cli::expand(study, {})) result.push_back(run.slug);
    return result;
}

}  // namespace

TEST_CASE("Broken study files are refused, with place and advice") {
    std::vector<fs::path> paths;
    for (const auto& entry : fs::directory_iterator(source / "tests/broken/study"))
        paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    CHECK(paths.size() >= 35);
    for (const fs::path& path : paths) {
        std::ifstream stream(path);
        std::string line;
        std::getline(stream, line);
        const std::string mark = "# expect: ";
        REQUIRE(line.rfind(mark, 0) == 0);
        const auto space = line.find(' ', mark.size());
        const std::string place = line.substr(mark.size(), space - mark.size());
        const std::string message = study_message(path);
        INFO(path.filename().string() << ": " << message);
        CHECK(message.rfind(path.string() + ":" + place, 0) == 0);
        CHECK(message.find(line.substr(space + 1)) != std::string::npos);
        CHECK(message.find('\n') == std::string::npos);
    }
}

TEST_CASE("A study file that is missing or cut short anywhere is refused") {
    CHECK(study_message(source / "nowhere.toml").find("nowhere.toml") != std::string::npos);
    std::ifstream stream(source / "examples/studies/shafts_soft.toml");
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    REQUIRE(text.size() > 500);
    const fs::path path = test::own_folder() / "study_cut_short.toml";
    for (std::size_t size = 0; size < text.size(); size += 7) {
        std::ofstream(path, std::ios::binary) << text.substr(0, size);
        CHECK_NOTHROW(study_message(path));
    }
    fs::remove(path);
}

TEST_CASE("The studies of the examples are sound") {
    std::size_t count = 0;
    for (const auto& entry : fs::directory_iterator(source / "examples/studies")) {
        if (entry.path().extension() != ".toml") continue;
        ++count;
        INFO(entry.path().filename().string());
        CHECK(study_message(entry.path()) == "");
    }
    CHECK(count >= 3);
}

TEST_CASE("Every combination of the axes is a run, in the file's order") {
    const auto study = cli::read_study_file(written(R"(
reference = { "solve.error" = 0.001 }
[axes]
"solve.refinement" = ["uniform", "view"]
solve.error = [0.1, 0.05, 0.03]      # the same as with quotes
)"));
    CHECK(study.measures.size() == 1);
    CHECK(study.measures[0].reference.overrides.at(0).text() == "solve.error=0.001");
    CHECK(cli::axis_keys(study) == std::vector<std::string>{"solve.refinement", "solve.error"});
    const auto runs = cli::expand(study, {});
    REQUIRE(runs.size() == 6);
    CHECK(runs[0].slug == "refinement-uniform_error-0.1");
    CHECK(runs[5].slug == "refinement-view_error-0.03");
    CHECK(runs[4].cells == std::vector<std::string>{"view", "0.05"});
    CHECK(runs[4].curve == "view");
    CHECK(runs[4].along == 0.05);
    // Pictures show what elements hold, on the same rays.
    CHECK(runs[4].override_texts() ==
          std::vector<std::string>{"render.scattering_tolerance=1e+09", "render.contrast=0",
                                   "solve.refinement=\"view\"", "solve.error=0.05"});
    CHECK(cli::scene_with(study, runs[4].overrides).solve.error == 0.05);
}

TEST_CASE("Several matrices are joined, each with its own curve to follow") {
    const auto study = cli::read_study_file(written(R"(
reference = { picture = { "solve.error" = 0.001 }, probe = { solve = { rays = 4096 } } }
measure = ["probe", "picture"]
set = { "solve.seed" = 7 }
[[axes]]
name = "coarse"
"solve.element_size" = [1, 0.5]
"solve.radiance" = ["constant", "linear"]
[[axes]]
along = "solve.rays"
"solve.error" = [0.1, 0.05, 0.03]
"solve.rays" = [16, 64]
)"));
    CHECK(study.measures[0].reference.overrides.at(0).text() == "solve.rays=4096");
    const auto runs = cli::expand(study, {});
    REQUIRE(runs.size() == 10);
    CHECK(runs[1].curve == "coarse, linear");
    CHECK(runs[1].cells == std::vector<std::string>{"1", "linear", "", ""});
    CHECK(runs[1].overrides[2].text() == "solve.seed=7");  // behind what all studies begin with
    CHECK(runs[9].curve == "error 0.03");
    CHECK(runs[9].along == 64.0);
    const auto names = slugs(study);
    CHECK(std::set<std::string>(names.begin(), names.end()).size() == names.size());
}

TEST_CASE("Flags --set and --seed hold for every run, but for axes") {
    const auto study = cli::read_study_file(written(R"(
reference = { "solve.error" = 0.001 }
axes = { "solve.error" = [0.1] }
)"));
    cli::CommonFlags flags;
    flags.settings = {{"solve.rays", "16"}};
    flags.seed = 5;
    const auto runs = cli::expand(study, flags);
    const auto file = cli::scene_with(study, runs[0].overrides);
    CHECK(file.solve.rays == 16);
    CHECK(file.solve.seed == 5);
    flags.settings = {{"solve.error", "0.5"}};
    CHECK_THROWS_AS(cli::expand(study, flags), mesh::InputError);
}
