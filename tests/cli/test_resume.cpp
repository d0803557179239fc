// A run that is stopped, killed or cut off, whenever it is, goes on from its last finished pass.
#include <chrono>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "radiosity/solution_file.h"
#include "render/compare.h"
#include "render/image_files.h"
#include "support/catch.h"
#include "support/foggy_box.h"
#include "support/program.h"

using namespace tyndall;
namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

constexpr double goal = 0.1;

std::vector<std::string> arguments(const std::string& out) {
    return {"run",
            "box.toml",
            "-o",
            out,
            "--json",
            "--set",
            "solve.error=" + std::to_string(goal),
            "--set",
            "solve.max_elements=20000"};
}

std::string line(const std::string& out) {
    std::string text;
    for (const auto& argument : arguments(out)) text += (text.empty() ? "" : " ") + argument;
    return text;
}

std::size_t leaves(const Json& report) {
    return report.at("patches").get<std::size_t>() + report.at("zones").get<std::size_t>();
}

// What a run left in its folder; everything that has its final name is whole.
struct Left {
    std::string last_pass;  // as the program names it; "" none
    std::size_t nodes = 0;  // of that pass's mesh, inner ones too
    std::size_t unfinished = 0;

    Left(const test::Workplace& place, const std::string& out) {
        std::error_code none;
        for (const auto& entry : fs::recursive_directory_iterator(place.path / out, none)) {
            const fs::path path = entry.path();
            CAPTURE(path);
            if (path.extension() == ".tmp") {
                CHECK(path.filename().string().front() == '.');
                ++unfinished;
            } else if (path.extension() == ".vtkhdf") {
                CHECK_NOTHROW(radiosity::read_solution(path));
                if (path.parent_path().filename() != "passes") continue;
                const auto name = fs::relative(path, place.path).string();
                if (name > last_pass) last_pass = name;
            } else if (path.extension() == ".exr") {
                CHECK_NOTHROW(render::read_image(path));
            } else if (path.extension() == ".png") {
                CHECK_THAT(mesh::read_file(path), Contains("IEND"));
            } else if (path.extension() == ".html") {
                CHECK(mesh::read_file(path).ends_with("</html>\n"));
            } else if (path.extension() == ".series") {
                const auto files = Json::parse(mesh::read_file(path)).at("files");
                for (std::size_t k = 0; k < files.size(); ++k) {
                    CHECK(files[k].at("time") == k + 1);
                    CHECK(fs::exists(place.path / out / files[k].at("name")));
                }
            } else if (path.extension() == ".json") {
                CHECK_NOTHROW(Json::parse(mesh::read_file(path)));
            } else {
                CHECK(entry.is_directory());
            }
        }
        if (last_pass.empty()) return;
        const auto forest = radiosity::read_solution(place.path / last_pass).solution.forest;
        nodes = forest.zone_count() + forest.patch_count();
    }
};

// A run that nothing interrupts, what others are measured by.
struct Whole {
    test::Workplace place{"resume"};
    Json report;
    std::chrono::duration<double> time{};
    render::Image image;

    Whole() {
        place.write("box.toml", test::foggy_box);
        const auto began = std::chrono::steady_clock::now();
        report = Json::parse(place.good(line("whole")));
        time = std::chrono::steady_clock::now() - began;
        image = render::read_image(place.path / "whole/image.exr");
        REQUIRE(report.at("estimated_error") <= goal);
        REQUIRE(place.has("whole/passes/02.vtkhdf"));
        REQUIRE_FALSE(report.contains("resumed_from"));
    }

    // Goes on to the end, from the last pass, to the goal and about the same result.
    void check_resumed(const std::string& out, const Left& left) const {
        const auto resumed = Json::parse(place.good(line(out) + " --resume"));
        CHECK(resumed.value("resumed_from", std::string()) == left.last_pass);
        CHECK(resumed.at("estimated_error") <= goal);
        CHECK(resumed.at("solver").at("converged") == true);
        // It may only add to the mesh, and ends where the same goal is met: the estimate of what
        // is left is redone on the finer mesh, so that some percent are bisected more.
        const Left after(place, out);
        CHECK(after.nodes >= left.nodes);
        CHECK(double(leaves(resumed)) == Approx(double(leaves(report))).epsilon(0.15));
        CHECK(after.unfinished == 0);
        // Both are within the goal of the truth.
        const auto picture = render::read_image(place.path / out / "image.exr");
        CHECK(render::compare(image.width, image.height, picture.layers.at(0), image.layers.at(0))
                  .rmse < 2.0 * goal);
    }
};

}  // namespace

TEST_CASE("a run that is killed goes on from its last finished pass, whenever that is", "[long]") {
    const Whole whole;
    std::size_t with_pass = 0;
    for (int k = 1; k <= 5; ++k) {
        CAPTURE(k);
        const std::string out = "killed" + std::to_string(k);
        test::Running run(whole.place.path, arguments(out));
        std::this_thread::sleep_for(k / 5.5 * whole.time);
        // Once surely after a pass, however the machine's load changes.
        const fs::path first = whole.place.path / out / "passes/01.vtkhdf";
        for (int wait = 0; k == 5 && wait < 6000 && !fs::exists(first); ++wait)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        run.signal(SIGKILL);
        run.wait();
        const Left left(whole.place, out);
        with_pass += !left.last_pass.empty();
        whole.check_resumed(out, left);
    }
    CHECK(with_pass > 0);
}

TEST_CASE("a run that is killed again and again comes to its end", "[long]") {
    const Whole whole;
    std::mt19937 random(7);
    auto goes_on = arguments("out");
    goes_on.push_back("--resume");
    std::string last;
    for (int k = 0; k < 6; ++k) {
        test::Running run(whole.place.path, goes_on);
        std::this_thread::sleep_for((random() % 1000) / 1000.0 * whole.time);
        run.signal(SIGKILL);
        run.wait();
        const Left left(whole.place, "out");
        CHECK(left.last_pass >= last);  // what is finished stays
        last = left.last_pass;
    }
    whole.check_resumed("out", Left(whole.place, "out"));
}

TEST_CASE("a run that is killed while it writes leaves no half file under its name", "[long]") {
    const Whole whole;
    // The kernel kills what writes more than so many blocks of 512 bytes to one file: in the middle
    // of the first pass, and soon and late in the second. All files are written by one function.
    const auto blocks = [&](const char* name) {
        return fs::file_size(whole.place.path / "whole" / name) / 512;
    };
    const auto first = blocks("passes/01.vtkhdf"), second = blocks("passes/02.vtkhdf");
    REQUIRE(second > first + 4);
    for (const auto limit : {first / 2, first + 2, second - 2}) {
        CAPTURE(limit, first, second);
        const std::string out = "cut" + std::to_string(limit);
        const auto killed =
            whole.place.run(line(out), "ulimit -c 0; ulimit -f " + std::to_string(limit) + ";");
        CHECK(killed.code != 0);
        const Left left(whole.place, out);
        CHECK(left.unfinished == 1);
        CHECK(left.last_pass == (limit < first ? "" : out + "/passes/01.vtkhdf"));
        whole.check_resumed(out, left);
    }
    // Where the kernel only refuses, as a full disk does: one message, and nothing left.
    const auto refused =
        whole.place.run(line("full"), "trap '' XFSZ; ulimit -f " + std::to_string(first / 2) + ";");
    CHECK(refused.code == 1);
    test::check_one_message(refused);
    CHECK_THAT(refused.err, Contains("01.vtkhdf") && Contains("too large"));
    CHECK(Left(whole.place, "full").unfinished == 0);
}

TEST_CASE("Ctrl-C at any moment leaves a valid solution, from which the run goes on", "[long]") {
    const Whole whole;
    for (int k = 1; k <= 4; ++k) {
        CAPTURE(k);
        const std::string out = "stopped" + std::to_string(k);
        test::Running run(whole.place.path, arguments(out));
        std::this_thread::sleep_for(k / 4.5 * whole.time);
        run.signal_group(SIGINT);
        const int code = test::exit_code(run.wait());
        const Left left(whole.place, out);
        // Before there is a mesh to speak of, the signal ends the program.
        if (code == 1000 + SIGINT) CHECK(left.last_pass.empty());
        if (code != 1000 + SIGINT) {
            CHECK(code == 0);
            CHECK(whole.place.has(out + "/solution.vtkhdf"));
            CHECK(!left.last_pass.empty());
            whole.place.good("render " + out + " -o again.exr --quiet");
        }
        whole.check_resumed(out, left);
    }
}

TEST_CASE("a run goes on with the same scene, settings and files alone") {
    const test::Workplace place("resume_other");
    const fs::path meshes = fs::path(TYNDALL_SOURCE_DIR) / "tests/meshes";
    const auto scene = mesh::read_file(meshes / "room.toml");
    place.write("room.toml", scene);
    fs::copy_file(meshes / "room41.msh", place.path / "room41.msh");
    const std::string run =
        "run room.toml -o out --set solve.rays=16 --set solve.gather_rays=16 --set "
        "solve.error=0.2";
    place.good(run);
    REQUIRE(place.has("out/passes/02.vtkhdf"));
    const auto before = place.read("out/passes/02.vtkhdf");
    const auto refused = [&](const std::string& more, const std::string& words) {
        CAPTURE(more, words);
        const auto outcome = place.run(run + " --resume " + more);
        CHECK(outcome.code == 1);
        CHECK(outcome.out == "");
        test::check_one_message(outcome);
        CHECK_THAT(outcome.err, Contains(words));
        CHECK(place.read("out/passes/02.vtkhdf") == before);
        CHECK(!place.has("out/passes/03.vtkhdf"));
    };
    refused("--seed 2", "there: nothing; here: seed = 2");
    refused("--set solve.error=0.1", "there: error = 0.2; here: error = 0.1");
    refused("--set material.plaster.reflectance=0.5", "other settings");
    place.write("room.toml", scene + "\n[render]\nsamples = 8\n");
    refused("", "another scene");
    // The same text, but the file it names has changed: one inner node has moved by 80 um.
    place.write("room.toml", scene);
    const auto own = place.read("room41.msh");
    auto moved = own;
    const std::string node = "1.253107416459577 0.7462800954163946";
    REQUIRE(moved.find(node) != std::string::npos);
    place.write("room41.msh",
                moved.replace(moved.find(node), node.size(), "1.253107416459577 0.7462"));
    refused("", "another base mesh");
    place.write("room41.msh", own);
    // A comment is no change.
    place.write("room.toml", "# the same\n" + scene);
    CHECK_THAT(place.good(run + " --resume"), Contains("resumed  out/passes/02.vtkhdf"));
    CHECK(place.has("out/passes/04.vtkhdf"));
    const auto series = Json::parse(place.read("out/passes.vtkhdf.series"));
    REQUIRE(series.at("files").size() == 4);
    CHECK(series.at("files")[3].at("name") == "passes/04.vtkhdf");
    CHECK(series.at("files")[3].at("time") == 4.0);
}

TEST_CASE("damaged solutions and passes are refused with one message by every command") {
    const test::Workplace place("resume_damaged");
    place.write("box.toml", test::foggy_box);
    place.write("points.csv", "1,1,1\n");
    place.good("run box.toml -o out --quiet");
    const auto bytes = place.read("out/passes/02.vtkhdf");
    std::vector<std::string> damaged{"", "format = 1", bytes.substr(0, bytes.size() - 16)};
    for (const int part : {1, 30, 60, 99})
        damaged.push_back(bytes.substr(0, bytes.size() * part / 100));
    std::mt19937 random(3);
    for (int k = 0; k < 6; ++k) {
        damaged.push_back(bytes);
        damaged.back()[random() % bytes.size()] ^= char(1 + random() % 255);
    }
    const char* commands[] = {"render out -o a.exr", "probe out --points points.csv",
                              "compare out out --solutions", "solve box.toml -o out --resume",
                              "solve box.toml -o new --replay out"};
    for (std::size_t k = 0; k < damaged.size(); ++k) {
        place.write("out/solution.vtkhdf", damaged[k]);
        place.write("out/passes/02.vtkhdf", damaged[k]);
        const std::string command = commands[k % std::size(commands)];
        CAPTURE(k, command);
        const auto outcome = place.run(command);
        CHECK(outcome.code == 1);
        CHECK(outcome.out == "");
        test::check_one_message(outcome);
        CHECK_THAT(outcome.err, Contains(".vtkhdf"));
    }
    const auto pass = place.run("run box.toml -o out --resume");
    CHECK_THAT(pass.err, Contains("Or remove that file"));
    fs::remove(place.path / "out/passes/02.vtkhdf");
    CHECK_THAT(place.good("run box.toml -o out --resume"),
               Contains("resumed  out/passes/01.vtkhdf"));
}
