// Runs the built program as a user does: exit codes, and what is said where.

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "render/image_files.h"
#include "support/catch.h"
#include "support/program.h"

namespace {

using namespace tyndall;
using test::check_one_message;
namespace fs = std::filesystem;

// A folder with pictures, in which the program is run.
struct ShellWorkplace : test::Workplace {
    ShellWorkplace() : test::Workplace("shell") {
        fs::create_directories(path / "out");
        render::Image image{8, 4, {{"beauty", 1, std::vector<float>(32, 2.0f)}}};
        render::write_image(path / "two.pfm", image);
        for (const char* name : {"emission", "surfaces_direct", "single_scattering"})
            image.layers.push_back({name, 1, std::vector<float>(32, 0.5f)});
        render::write_image(path / "out" / "image.exr", image);
        image.layers.resize(1);
        image.layers[0].values[0] = 2.5f;
        render::write_image(path / "other.pfm", image);
        image.layers[0].values[0] = std::nanf("");
        render::write_image(path / "nan.pfm", image);
        render::write_image(path / "small.pfm",
                            {4, 4, {{"beauty", 1, std::vector<float>(16, 2.0f)}}});
    }
};

}  // namespace

TEST_CASE("help and version go to stdout, and are no failure") {
    const ShellWorkplace place;
    const auto help = place.run("--help");
    CHECK(help.code == 0);
    CHECK_THAT(help.out, Contains("compare") && Contains("Examples"));
    CHECK(help.err.empty());
    CHECK(place.run("--version").out.rfind("tyndall ", 0) == 0);
    CHECK(place.run("help").out == help.out);
    const auto compare = place.run("compare --help");
    CHECK(place.run("help compare").out.size() + 8 >= compare.out.size());
    CHECK(place.run("help comprae").code == 2);
    CHECK(compare.code == 0);
    CHECK_THAT(compare.out, Contains("--layer") && Contains("--threads") && Contains("Examples"));
}

TEST_CASE("wrong usage exits with 2 and says what was meant") {
    const ShellWorkplace place;
    const auto bare = place.run("");
    CHECK(bare.code == 2);
    CHECK_THAT(bare.err, Contains("Usage"));
    const auto mistyped = place.run("comprae a b");
    CHECK(mistyped.code == 2);
    CHECK_THAT(mistyped.err, Contains("comprae") && Contains("Did you mean \"compare\""));
    const auto flag = place.run("compare a.pfm b.pfm --laier=x");
    CHECK(flag.code == 2);
    CHECK_THAT(flag.err, Contains("'--laier'") && Contains("Did you mean \"--layer\""));
    const auto early = place.run("--quiet compare a.pfm b.pfm");
    CHECK(early.code == 2);
    CHECK_THAT(early.err, Contains("behind the command"));
    const auto missing = place.run("compare a.pfm");
    CHECK(missing.code == 2);
    CHECK_THAT(missing.err, Contains("B is required") && Contains("tyndall compare --help"));
    const auto many = place.run("compare a.pfm b.pfm c.pfm");
    CHECK(many.code == 2);
    CHECK_THAT(many.err, Contains("c.pfm"));
    CHECK(place.run("compare a.pfm b.pfm --threads many").code == 2);
    CHECK(place.run("compare two.pfm two.pfm --max-rmse -1").code == 2);
    CHECK(place.run("--nonsense").code == 2);
}

TEST_CASE("bad input exits with 1 and one message") {
    const ShellWorkplace place;
    const std::string arguments =
        GENERATE(as<std::string>{}, "compare none.pfm two.pfm", "compare two.pfm small.pfm",
                 "compare . two.pfm", "compare out two.pfm --layer nope", "compare out.txt two.pfm",
                 "compare two.pfm nan.pfm", "compare two.pfm other.pfm --difference no/where.png");
    CAPTURE(arguments);
    const auto outcome = place.run(arguments);
    CHECK(outcome.code == 1);
    CHECK(outcome.out.empty());
    check_one_message(outcome);
}

TEST_CASE("compare tells the errors, in words and as JSON") {
    const ShellWorkplace place;
    const auto words = place.run("compare two.pfm two.pfm");
    CHECK(words.code == 0);
    CHECK(words.err.empty());
    CHECK_THAT(words.out, Contains("0.0000 %") && Contains("8 x 4"));
    const auto outcome = place.run("compare other.pfm two.pfm --json --difference off.png");
    CHECK(outcome.code == 0);
    const auto json = nlohmann::json::parse(outcome.out);
    CHECK(json.at("bias").get<double>() == Approx(0.5 / 32.0 / 2.0));
    CHECK(json.at("max_error").get<double>() == Approx(0.25));
    CHECK(json.at("width") == 8);
    CHECK(place.read("off.png").substr(1, 3) == "PNG");
}

TEST_CASE("compare understands folders, layers and their sum") {
    const ShellWorkplace place;
    CHECK(place.run("compare out two.pfm --max-rmse 0").code == 0);
    CHECK(place.run("compare out/ out/image.exr --max-rmse 0").code == 0);
    const auto sum = place.run("compare out two.pfm --layer direct_single --json");
    CHECK(nlohmann::json::parse(sum.out).at("mean").get<double>() == Approx(1.5));
    const auto layer = place.run("compare out two.pfm --layer emission --json");
    CHECK(nlohmann::json::parse(layer.out).at("bias").get<double>() == Approx(-0.75));
}

TEST_CASE("compare judges: limits and values that are not finite") {
    const ShellWorkplace place;
    CHECK(place.run("compare other.pfm two.pfm --max-block4 0.02").code == 0);
    const auto worse = place.run("compare other.pfm two.pfm --max-rmse 0.01 --max-bias 1e-3");
    CHECK(worse.code == 1);
    check_one_message(worse);
    CHECK_THAT(worse.err, Contains("rmse") && Contains("bias"));
    const auto broken = place.run("compare nan.pfm two.pfm");
    CHECK(broken.code == 1);
    CHECK_THAT(broken.err, Contains("not finite"));
    CHECK(place.run("compare other.pfm two.pfm --quiet").out.empty());
}

TEST_CASE("a reader of stdout that goes away is no failure; a full disk is one") {
    const ShellWorkplace place;
    // The reader has ended before the program begins to write.
    const std::string line =
        "cd '" + place.path.string() +
        "' && { sleep 0.2; '" TYNDALL_BINARY_DIR
        "/bin/tyndall' compare two.pfm two.pfm 2>err.txt; echo $? >code.txt; } | true";
    CHECK(std::system(line.c_str()) == 0);
    CHECK(place.read("code.txt") == "0\n");
    CHECK(place.read("err.txt").empty());
    if (::access("/dev/full", W_OK) != 0) return;
    const auto full = place.run("compare two.pfm two.pfm >/dev/full");
    CHECK(full.code == 1);
    CHECK_THAT(full.err, Contains("standard output"));
}
