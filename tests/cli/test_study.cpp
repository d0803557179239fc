// Real, tiny studies: the matrix, what is kept, widening, failures, stops.

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "cli/study_record.h"
#include "render/image_files.h"
#include "support/catch.h"
#include "support/program.h"

using namespace tyndall;
namespace fs = std::filesystem;

namespace {

// A lamp over haze; a run of it takes half a second.
constexpr const char* hazy_scene = R"(format = 1
material = [ { name = "grey", reflectance = 0.5 },
             { name = "lamp", reflectance = 0.0, emission = 100.0 } ]
surface  = [ { name = "room", material = "grey", room = { min = [0, 0, 0], max = [1, 1, 1] } },
             { name = "lamp", material = "lamp", rectangle = { corner = [0.3, 0.3, 1], u = [0, 0.3, 0], v = [0.3, 0, 0] } } ]
medium   = [ { name = "haze", extinction = 0.5, albedo = 0.8 } ]
camera   = [ { name = "main", eye = [0.9, 0.1, 0.5], target = [0.3, 0.6, 0.4], fov_y = 60, width = 16, height = 12 } ]
solve    = { rays = 16, gather_rays = 16, element_size = 0.7 }
render   = { samples = 4 }
)";

struct StudyWorkplace : test::Workplace {
    explicit StudyWorkplace(const std::string& name = "study") : test::Workplace(name) {
        write("scene.toml", hazy_scene);
    }
    // When the run was made; it is made anew where this changes.
    fs::file_time_type made(const std::string& slug) const {
        return fs::last_write_time(path / "out/runs" / slug / "solution.vtkhdf");
    }
    std::size_t rows() const {
        const auto csv = read("out/study.csv");
        return static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')) - 1;
    }
};

const std::string two_runs = R"(scene = "scene.toml"
reference = { "solve.refinement" = "uniform", "solve.element_size" = 0.5 }
measure = ["picture", "single_scattering", "surfaces", "media", "probe"]
errors = [0.5]
probe = { count = 8, rays = 64 }
[axes]
"solve.refinement" = ["uniform"]
"solve.element_size" = [0.8, 0.6]
)";

}  // namespace

TEST_CASE("A study runs its matrix, measures, plots, and keeps what is done", "[long]") {
    // Run once; what each section goes on with is a copy.
    static const StudyWorkplace done;
    static const auto first = [] {
        done.write("study.toml", two_runs);
        return done.run("study study.toml -o out --json");
    }();
    INFO(first.err);
    REQUIRE(first.code == 0);
    const StudyWorkplace place("study_copy");
    fs::copy(done.path, place.path,
             fs::copy_options::recursive | fs::copy_options::overwrite_existing);
    const auto rows = nlohmann::json::parse(first.out).at("rows");
    REQUIRE(rows.size() == 2);
    CHECK(rows[0].at("solve.element_size") == "0.8");
    CHECK(rows[0].at("zones").get<int>() < rows[1].at("zones").get<int>());
    for (const auto& row : rows) {
        CHECK(row.at("cpu_seconds").get<double>() > 0.0);
        CHECK(row.at("memory_bytes").get<double>() > 1e6);
        for (const char* measure : {"picture", "single_scattering", "surfaces", "media", "probe"})
            CHECK(row.at(std::string(measure) + "_rmse").get<double>() > 0.0);
        CHECK(row.at("probe_block4").is_null());
        CHECK(row.at("tet_quality_min").get<double>() > 0.0);
        CHECK(row.at("tet_quality_mean").get<double>() < 1.0);
        const fs::path folder = place.path / "out" / row.at("folder").get<std::string>();
        for (const char* name : {"image.exr", "image.png", "overlay.png", "slice.png",
                                 "solution.vtkhdf", "difference_picture.png"})
            CHECK(fs::exists(folder / name));
        // What the study says is what `tyndall compare` says.
        const auto compared =
            place.run("compare '" + folder.string() + "' out/references/reference --json");
        CHECK(nlohmann::json::parse(compared.out).at("rmse").get<double>() ==
              Approx(row.at("picture_rmse").get<double>()));
    }
    for (const char* name :
         {"study.csv", "targets.csv", "study.md", "plots/picture_rmse_cpu.svg",
          "plots/single_scattering_block4_elements.svg", "plots/probe_rmse_elements.svg"})
        CHECK(fs::file_size(place.path / "out" / name) > 0);

    SECTION("again: nothing is run, all is said") {
        const auto before = place.made("refinement-uniform_element_size-0.6");
        const auto again = place.run("study study.toml -o out --json");
        CHECK(again.code == 0);
        CHECK(again.out == first.out);
        CHECK(place.made("refinement-uniform_element_size-0.6") == before);
        CHECK(place.run("study study.toml -o out --again --quiet").code == 0);
        CHECK(place.made("refinement-uniform_element_size-0.6") != before);
    }
    SECTION("widened: only what is new is run") {
        const auto before = place.made("refinement-uniform_element_size-0.6");
        auto wider = two_runs;
        wider.replace(wider.find("[0.8, 0.6]"), 10, "[0.8, 0.6, 0.55]");
        place.write("study.toml", wider);
        CHECK(place.run("study study.toml -o out --quiet").code == 0);
        CHECK(place.rows() == 3);
        CHECK(place.made("refinement-uniform_element_size-0.6") == before);
    }
    SECTION("another slice: the same runs, drawn again") {
        const auto before = place.made("refinement-uniform_element_size-0.6");
        const auto slice = place.path / "out/runs/refinement-uniform_element_size-0.6/slice.png";
        const auto drawn = mesh::read_file(slice);
        place.write("study.toml", std::string("slice = { point = [0.2, 0.5, 0.5], normal = [1, 0, "
                                              "0] }\n") +
                                      two_runs);
        CHECK(place.run("study study.toml -o out --quiet").code == 0);
        CHECK(place.made("refinement-uniform_element_size-0.6") == before);
        CHECK(mesh::read_file(slice) != drawn);
    }
    SECTION("another scene: all is run again") {
        const auto before = place.made("refinement-uniform_element_size-0.6");
        place.write("scene.toml", std::string(hazy_scene) + "environment = { radiance = 1.0 }\n");
        CHECK(place.run("study study.toml -o out --quiet").code == 0);
        CHECK(place.made("refinement-uniform_element_size-0.6") != before);
    }
    SECTION("files as references, for each measure its own") {
        place.write("points.csv", "0.5,0.5,0.5\n0.2,0.7,0.3\n");
        REQUIRE(
            place.run("probe out/references/reference --points points.csv -o values.csv").code ==
            0);
        auto filed = two_runs;
        const std::string finer =
            "{ \"solve.refinement\" = \"uniform\", \"solve.element_size\" = 0.5 }";
        filed.replace(
            filed.find(finer), finer.size(),
            "{ picture = \"out/references/reference/image.exr\", single_scattering = "
            "\"out/references/reference\", surfaces = \"out/references/reference\", media = "
            "\"out/references/reference/image.exr\", probe = \"values.csv\" }");
        place.write("study.toml", filed);
        const auto outcome = place.run("study study.toml -o out --json");
        INFO(outcome.err);
        CHECK(outcome.code == 0);
        const auto same = nlohmann::json::parse(outcome.out).at("rows");
        CHECK(same[0].at("picture_rmse") == rows[0].at("picture_rmse"));
        CHECK(same[0].at("probe_rmse") != rows[0].at("probe_rmse"));  // other points
    }
}

TEST_CASE("A run that fails is recorded, and the others go on", "[long]") {
    const StudyWorkplace place;
    // A medium outside the room shows only when the scene is meshed.
    place.write("scene.toml", [&] {
        std::string text = hazy_scene;
        const std::string haze = "albedo = 0.8 }";
        text.replace(text.find(haze), haze.size(), "albedo = 0.8, at = [0.5, 0.5, 0.5] }");
        return text;
    }());
    place.run("run scene.toml -o good");
    place.write("study.toml", R"(scene = "scene.toml"
reference = "good/image.exr"
[axes]
"medium.haze.at" = [[0.5, 0.5, 0.5], [3, 3, 3], [0.4, 0.5, 0.5]]
)");
    const auto outcome = place.run("study study.toml -o out");
    CHECK(outcome.code == 1);
    CHECK_THAT(outcome.err, Contains("1 of 3 runs failed"));
    CHECK(place.rows() == 3);
    const auto record = cli::read_record(place.path / "out/runs/at-3-3-3-");
    REQUIRE(record);
    CHECK(record->failed());
    CHECK_THAT(record->failure, Contains("haze"));
    CHECK_THAT(place.read("out/study.md"), Contains("1 of which failed"));
}

TEST_CASE("An axis that changes the scene has a reference for each of its values", "[long]") {
    const StudyWorkplace place;
    place.write("study.toml", R"(scene = "scene.toml"
reference = { "solve.refinement" = "uniform", "solve.element_size" = 0.6 }
[axes]
"medium.haze.extinction" = [0.2, 2.0]
"solve.refinement" = ["uniform"]
"solve.element_size" = [0.8, 0.6]
)");
    const auto outcome = place.run("study study.toml -o out --json");
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    const auto rows = nlohmann::json::parse(outcome.out).at("rows");
    REQUIRE(rows.size() == 4);
    for (const char* name : {"extinction-0.2", "extinction-2.0"})
        CHECK(fs::exists(place.path / "out/references" / name / "image.exr"));
    // The run that is the reference's own is off by nothing, thick or thin: the same bits.
    for (const auto& row : rows) {
        const double error = row.at("picture_rmse").get<double>();
        if (row.at("solve.element_size") == "0.6")
            CHECK(error == 0.0);
        else
            CHECK(error > 0.0);
    }
}

TEST_CASE("What cannot be measured is said before any run") {
    const StudyWorkplace place;
    render::write_image(place.path / "small.pfm",
                        {4, 4, {{"beauty", 1, std::vector<float>(16, 2.0f)}}});
    place.write("study.toml", R"(scene = "scene.toml"
reference = "small.pfm"
axes = { "solve.rays" = [16] }
)");
    const auto outcome = place.run("study study.toml -o out");
    CHECK(outcome.code == 1);
    CHECK_THAT(outcome.err, Contains("study.toml:2:13: ") && Contains("4 × 4"));
    CHECK_FALSE(fs::exists(place.path / "out/runs"));
    CHECK(place.run("study study.toml").code == 2);
}

TEST_CASE("A study that is stopped or killed goes on where it was", "[long]") {
    const StudyWorkplace place;
    auto text = two_runs;
    text.replace(text.find("[0.8, 0.6]"), 10, "[0.8, 0.65, 0.6, 0.55]");
    place.write("study.toml", text);
    const int signal = GENERATE(SIGINT, SIGKILL);
    test::Running child(place.path, {"study", "study.toml", "-o", "out", "--quiet"});
    // Not before the first run is done; a minute is enough on any machine.
    const auto first = place.path / "out/runs/refinement-uniform_element_size-0.8/run.json";
    for (int k = 0; k < 6000 && !fs::exists(first); ++k)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    REQUIRE(fs::exists(first));
    child.signal(signal);
    const int code = test::exit_code(child.wait());
    if (signal == SIGINT) CHECK(code == 1);
    // A child of the killed study ends by itself; until then it may hold its folder.
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    const auto before = place.made("refinement-uniform_element_size-0.8");
    const auto outcome = place.run("study study.toml -o out --quiet");
    INFO(outcome.err);
    CHECK(outcome.code == 0);
    CHECK(place.rows() == 4);
    CHECK(place.made("refinement-uniform_element_size-0.8") == before);
}
