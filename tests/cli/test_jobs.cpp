// run, solve, render, probe and check as a user runs them, on a small foggy box.

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "mesh/file_bytes.h"
#include "render/image_files.h"
#include "support/catch.h"
#include "support/foggy_box.h"
#include "support/program.h"

namespace {

using namespace tyndall;
namespace fs = std::filesystem;

struct JobsWorkplace : test::Workplace {
    JobsWorkplace() : test::Workplace("jobs") { write("box.toml", test::foggy_box); }
};

std::vector<std::vector<double>> numbers(const std::string& csv) {
    std::vector<std::vector<double>> rows;
    std::istringstream lines(csv);
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line)) {
        rows.emplace_back();
        std::istringstream fields(line);
        for (std::string field; std::getline(fields, field, ',');)
            rows.back().push_back(std::stod(field));
    }
    return rows;
}

}  // namespace

TEST_CASE("run writes a solution, pictures and a report") {
    const JobsWorkplace place;
    const auto summary = place.good("run box.toml -o deep/out");
    CHECK_THAT(summary, Contains("patches") && Contains("wrote") && Contains("report.json"));
    for (const char* name : {"solution.vtkhdf", "image.exr", "image.png", "report.json"})
        CHECK(place.has(std::string("deep/out/") + name));

    const auto report = nlohmann::json::parse(place.read("deep/out/report.json"));
    for (const char* key :
         {"scene", "version", "seed", "threads", "patches", "zones", "passes", "cpu_seconds",
          "wall_seconds", "peak_memory_bytes", "solver", "closure_error", "reciprocity_error",
          "energy_balance", "direct_power_check", "net_power", "estimated_error", "warnings"}) {
        CAPTURE(key);
        CHECK(report.contains(key));
    }
    CHECK(report["scene"] == "box.toml");
    CHECK(report["solver"]["converged"] == true);
    CHECK(report["passes"].size() > 1);
    CHECK(report["zones"].get<int>() > 10);
    CHECK(report["peak_memory_bytes"].get<double>() > 1e6);

    const auto image = render::read_image(place.path / "deep/out/image.exr");
    const auto& beauty = image.layers.at(0).values;
    std::vector<double> sum(beauty.size(), 0.0);
    for (const char* name : {"emission", "surfaces_direct", "surfaces_indirect",
                             "single_scattering", "multiple_scattering"}) {
        REQUIRE(image.find(name));
        for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += image.find(name)->values[k];
    }
    // Six values rounded to single precision each.
    for (std::size_t k = 0; k < sum.size(); ++k) CHECK(beauty[k] == Approx(sum[k]).epsilon(1e-6));
    CHECK(*std::max_element(beauty.begin(), beauty.end()) > 0.0f);
    CHECK(image.find("depth"));
}

TEST_CASE("a solution file alone makes the run's picture again, and others") {
    const JobsWorkplace place;
    place.good("run box.toml -o out --quiet --seed 7");
    place.good("render out/ -o again.exr");
    CHECK(place.read("again.exr") == place.read("out/image.exr"));
    const auto solved = place.good("solve box.toml -o out --seed 7");
    CHECK_THAT(solved, Contains("of an earlier run"));
    place.write("box.toml", "gone");
    place.good("render out/ -o again.png");
    CHECK(place.read("again.png") == place.read("out/image.png"));
    place.good("render out/solution.vtkhdf --seed 8 -o other.exr --quiet");
    CHECK(place.read("other.exr") != place.read("out/image.exr"));

    place.good("render out --layer direct_single -o layer.pfm");
    place.good("compare layer.pfm out --layer direct_single --max-rmse 0");
    const auto json =
        nlohmann::json::parse(place.good("render out --camera side --samples 1 -o side.pfm --json "
                                         "--set camera.side.width=12"));
    CHECK(json["camera"] == "side");
    CHECK(json["width"] == 12);
    CHECK(render::read_image(place.path / "side.pfm").width == 12);
    place.good("render out --exposure 2 -o bright.png");
    CHECK(place.read("bright.png") != place.read("again.png"));
}

TEST_CASE("solve makes no picture; its file is the same at any thread count") {
    const JobsWorkplace place;
    const auto report =
        nlohmann::json::parse(place.good("solve box.toml -o one --threads 1 --json"));
    CHECK(report["threads"] == 1);
    CHECK(!place.has("one/image.exr"));
    CHECK(nlohmann::json::parse(place.read("one/report.json")) == report);
    CHECK(place.good("solve box.toml -o two --threads 2 --quiet").empty());
    CHECK(place.read("one/solution.vtkhdf") == place.read("two/solution.vtkhdf"));
    place.good("solve box.toml -o two --set solve.seed=2 --quiet");
    CHECK(place.read("one/solution.vtkhdf") != place.read("two/solution.vtkhdf"));
}

TEST_CASE("a scene without a camera gives no picture, and says so") {
    const JobsWorkplace place;
    std::string text = test::foggy_box;
    const auto begin = text.find("[[camera]]");
    text.erase(begin, text.find("[solve]") - begin);
    place.write("blind.toml", text);
    CHECK_THAT(place.good("run blind.toml -o out"), Contains("no camera"));
    CHECK(place.has("out/solution.vtkhdf"));
    CHECK(!place.has("out/image.exr"));
    const auto render = place.run("render out -o a.png");
    CHECK(render.code == 1);
    CHECK_THAT(render.err, Contains("no camera"));
}

TEST_CASE("probe writes the points in order, with values") {
    const JobsWorkplace place;
    place.good("solve box.toml -o out --quiet");
    place.write("points.csv",
                "\xef\xbb\xbfx, y ,z\r\n1,1,1.5\r\n\r\n# low\n0.25,1e-1,+0.5\n1,1,1.5");
    const auto csv = place.good("probe out --points points.csv --rays 64");
    CHECK(csv.rfind("x,y,z,J,J_direct,G,G_direct\n", 0) == 0);
    const auto rows = numbers(csv);
    REQUIRE(rows.size() == 3);
    CHECK(rows[0] == rows[2]);
    CHECK(rows[1][1] == 0.1);
    for (const auto& row : rows) {
        REQUIRE(row.size() == 7);
        CHECK(row[3] > row[4]);
        CHECK(row[4] > 0.0);
        // No emission in the fog: J = albedo G / 4 pi.
        CHECK(row[3] == Approx(0.8 * row[5] / (4.0 * M_PI)));
        CHECK(row[4] == Approx(0.8 * row[6] / (4.0 * M_PI)));
    }
    CHECK(place.good("probe out --points points.csv --rays 64 --threads 1") == csv);
    CHECK_THAT(place.good("probe out --points points.csv --rays 64 -o r.csv"),
               Contains("3 points"));
    CHECK(place.read("r.csv") == csv);

    // On the floor and below the lamp; the second looks away from it.
    place.write("walls.csv", "1,1,0,0,0,1\n1,1,1.9,0,0,-1\n");
    const auto json =
        nlohmann::json::parse(place.good("probe out --points walls.csv --rays 64 --json"));
    CHECK(json["columns"].size() == 8);
    CHECK(json["rows"][0][6].get<double>() > json["rows"][0][7].get<double>());
    CHECK(json["rows"][0][7].get<double>() > 0.0);
    CHECK(json["rows"][1][7].get<double>() == 0.0);
}

TEST_CASE("three bands have a column and a channel each") {
    const JobsWorkplace place;
    place.good("run box.toml -o out --quiet --set bands=3 --set material.lamp.emission=[10,5,0]");
    place.write("points.csv", "1,1,1\n");
    const auto csv = place.good("probe out --points points.csv --rays 64");
    CHECK(csv.rfind("x,y,z,J_0,J_1,J_2,J_direct_0,J_direct_1,J_direct_2,G_0,", 0) == 0);
    const auto rows = numbers(csv);
    REQUIRE(rows.at(0).size() == 15);
    // All is linear in the emission; the gather sums single-precision fields.
    CHECK(rows[0][3] == Approx(2.0 * rows[0][4]).epsilon(1e-5));
    CHECK(rows[0][5] == 0.0);
    place.good("render out -o a.pfm");
    CHECK(render::read_image(place.path / "a.pfm").layers[0].channels == 3);
    CHECK(place.good("render out -o a.exr") != "");
    CHECK(place.read("a.exr") == place.read("out/image.exr"));
}

TEST_CASE("an interrupt leaves a solution that can be used", "[long]") {
    const JobsWorkplace place;
    // Enough to do for many seconds. --foreground: one signal, to the program alone; two would end
    // it.
    const auto outcome = place.run(
        "run box.toml -o out --set solve.error=1e-4 --set solve.max_elements=200000 "
        "--set solve.gather_rays=512",
        "timeout --foreground --preserve-status -s INT 2");
    CHECK(outcome.code == 0);
    CHECK_THAT(outcome.out, Contains("stopped on request"));
    CHECK(!place.has("out/image.exr"));
    const auto report = nlohmann::json::parse(place.read("out/report.json"));
    CHECK(!report["warnings"].empty());
    place.good("render out -o a.png");
}

TEST_CASE("check tells about a scene and writes nothing") {
    const JobsWorkplace place;
    const auto text = place.good("check box.toml");
    CHECK_THAT(text, Contains("sound") && Contains("fog 8 m3") && Contains("ceiling_lamp+") &&
                         Contains("no light leaves"));
    const auto json = nlohmann::json::parse(place.good("check box.toml --json"));
    CHECK(json["open"] == false);
    CHECK(json["media"][0]["volume"].get<double>() == Approx(8.0));
    CHECK(json["memory_foreseen_bytes"]["most"].get<double>() > 1e6);
    CHECK(json["cameras"].size() == 2);
    CHECK(std::distance(fs::directory_iterator(place.path), fs::directory_iterator()) == 3);
    CHECK(place.run("check none.toml").code == 1);
}

TEST_CASE("what cannot be done exits with 1 and one line that says where and what to do") {
    const JobsWorkplace place;
    place.good("solve box.toml -o out --quiet");
    place.write("file", "");
    place.write("bad.csv", "x,y,z\n1,1,1\n\n1,zwei,1\n");
    place.write("outside.csv", "1,1,1\n9,9,9\n8,8,8\n");
    place.write("mixed.csv", "1,1,1\n1,1,1,0,0,1\n");
    place.write("names.csv", "x,y,w\n1,1,1\n");
    place.write("empty.csv", "x,y,z\n");
    place.write("nan.csv", "1,nan,1\n");
    place.write("normal.csv", "1,1,1,0,0,0\n");
    fs::create_directories(place.path / "nothing");
    const std::pair<const char*, const char*> cases[] = {
        {"run none.toml -o new", "none.toml"},
        {"run box.toml -o file", "it is a file"},
        {"run box.toml -o file/below", "file/below"},
        {"run box.toml -o new --set solve.eror=1", "error"},
        {"render nothing -o a.exr", "solution.vtkhdf"},
        {"render box.toml -o a.exr", "box.toml is a scene, not a solution"},
        {"render out -o a.jpg", ".exr, .pfm or .png"},
        {"render out -o no/a.exr", "no folder"},
        {"render out -o a.exr --camera back", "\"main\", \"side\""},
        {"render out -o a.exr --method magic", "line_of_sight"},
        {"render out -o a.exr --layer magic", "beauty"},
        {"render out -o a.exr --set solve.error=1", "render and camera"},
        {"render out -o a.exr --set camera.main.widht=1", "width"},
        {"probe out --points none.csv", "none.csv"},
        {"probe out --points bad.csv", "bad.csv:4: y is \"zwei\""},
        {"probe out --points outside.csv", "outside.csv:2: the point [9, 9, 9] lies outside"},
        {"probe out --points mixed.csv", "mixed.csv:2: 6 values instead of 3"},
        {"probe out --points names.csv", "names.csv:1: column 3"},
        {"probe out --points empty.csv", "no point"},
        {"probe out --points nan.csv", "nan.csv:1:"},
        {"probe out --points normal.csv", "normal.csv:1:"},
    };
    for (const auto& [arguments, words] : cases) {
        CAPTURE(arguments);
        const auto outcome = place.run(arguments);
        CHECK(outcome.code == 1);
        CHECK(outcome.out == "");
        CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
        CHECK_THAT(outcome.err, Contains(words));
    }
    CHECK(!place.has("new"));
    CHECK(!place.has("a.exr"));
}

TEST_CASE("wrong usage of the jobs exits with 2") {
    const JobsWorkplace place;
    for (const char* arguments :
         {"run box.toml", "run -o out", "solve box.toml --out x", "render out", "probe out",
          "check", "check box.toml more", "render out -o a.exr --samples 0",
          "probe out --points p.csv --rays none"}) {
        CAPTURE(arguments);
        CHECK(place.run(arguments).code == 2);
    }
}

TEST_CASE("A run goes on from its last pass; a pass is replayed as it is") {
    const JobsWorkplace place;
    const auto elements = [&](const std::string& arguments) {
        const auto report = nlohmann::json::parse(place.good(arguments + " --json"));
        return report["patches"].get<int>() + report["zones"].get<int>();
    };
    const std::string settings = " --set solve.error=0.05";
    const int whole = elements("solve box.toml -o out" + settings);
    REQUIRE(place.has("out/passes/01.vtkhdf"));
    REQUIRE(place.has("out/passes/02.vtkhdf"));
    // As a kill in the middle of the second pass leaves it.
    fs::remove(place.path / "out/passes/02.vtkhdf");
    fs::remove(place.path / "out/solution.vtkhdf");
    const int resumed = elements("solve box.toml -o out --resume" + settings);
    CHECK(resumed == Approx(whole).epsilon(0.1));  // the goal is the same, not the bits
    CHECK(place.has("out/passes/03.vtkhdf"));
    const int replayed =
        elements("solve box.toml -o again --replay out/passes/03.vtkhdf" + settings);
    CHECK(replayed == resumed);

    const auto other = place.run("solve box.toml -o out --resume");
    CHECK(other.code == 1);
    CHECK_THAT(other.err, Contains("another scene") && Contains("03.vtkhdf"));
}
