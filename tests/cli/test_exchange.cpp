// tyndall exchange as a user runs it.
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "support/catch.h"
#include "support/program.h"

using namespace tyndall;

namespace {

constexpr const char* squares = R"(format = 1
material = [ { name = "grey", reflectance = 0.5 } ]
surface  = [ { name = "low", material = "grey", rectangle = { corner = [0, 0, 0], u = [1, 0, 0], v = [0, 1, 0] } },
             { name = "high", material = "grey", rectangle = { corner = [0, 0, 1], u = [0, 1, 0], v = [1, 0, 0] } },
             { name = "side", material = "grey", rectangle = { corner = [0, 0, 0], u = [0, 1, 0], v = [0, 0, 1] } } ]
)";

constexpr const char* foggy_cube = R"(format = 1
material = [ { name = "grey", reflectance = 0.5 } ]
surface  = [ { name = "room", material = "grey", room = { min = [0, 0, 0], max = [1, 1, 1] } } ]
medium   = [ { name = "haze", extinction = 1.0, albedo = 0.5 } ]
)";

// What a run that must succeed prints.
std::string printed(const test::Workplace& place, const std::string& line) {
    const auto outcome = place.run("exchange " + line);
    INFO(line << ": " << outcome.err);
    REQUIRE(outcome.code == 0);
    return outcome.out;
}

// "from,to" → exchange area.
std::map<std::string, double> areas(const std::string& csv) {
    std::istringstream lines(csv);
    std::string line;
    std::getline(lines, line);
    CHECK(line == "from,to,exchange_area");
    std::map<std::string, double> result;
    while (std::getline(lines, line)) {
        const auto comma = line.rfind(',');
        CHECK(result.emplace(line.substr(0, comma), std::stod(line.substr(comma + 1))).second);
    }
    return result;
}

}  // namespace

TEST_CASE("Squares by contour integration: all pairs, to 1e-12") {
    const test::Workplace place("exchange");
    place.write("squares.toml", squares);
    const auto outcome = place.run("exchange squares.toml --method contour_integration");
    REQUIRE(outcome.code == 0);
    CHECK_THAT(outcome.err, Contains("closure error") && Contains("reciprocity error"));
    const auto area = areas(outcome.out);
    // Six sides and outside, each with each, but for outside with itself.
    CHECK(area.size() == 48);
    const auto close = [](double x) { return Approx(x).epsilon(1e-12); };
    CHECK(area.at("low+,high+") == close(0.199824895698387));
    CHECK(area.at("high+,low+") == close(0.199824895698387));
    CHECK(area.at("low+,side+") == close(0.200043776075403));
    CHECK(area.at("low-,high+") == 0.0);
    CHECK(area.at("low-,outside") == close(1.0));
    CHECK(area.at("outside,low+") == close(1.0 - 0.199824895698387 - 0.200043776075403));
}

TEST_CASE("Some pairs only: names of sides, surfaces, parts and media", "[long]") {
    const test::Workplace place("exchange");
    place.write("cube.toml", foggy_cube);
    const std::string method = " --method reference_pairs --tolerance 1e-5 ";
    const auto one = areas(printed(place, "cube.toml --from haze --to room.floor" + method));
    CHECK(one.size() == 1);
    CHECK(one.at("haze,room.floor+") == Approx(0.44602745645511066).epsilon(1e-5));
    const auto walls = areas(printed(place, "cube.toml --from room --to haze --to room.x0+"));
    CHECK(walls.size() == 12);
    printed(place, "cube.toml --from haze --to haze -o areas.csv --quiet" + method);
    CHECK(areas(place.read("areas.csv")).at("haze,haze") ==
          Approx(1.3238352612693434).epsilon(1e-5));
    const auto json = nlohmann::json::parse(printed(place, "cube.toml --rays 4096 --json"));
    CHECK(json.at("entries").size() == 49 + 7 + 7);
    CHECK(json.at("closure_error").get<double>() < 1e-12);
    CHECK(json.at("reciprocity_error").get<double>() > 0.0);
}

TEST_CASE("What a method cannot do is said with the pair and the methods that can") {
    const test::Workplace place("exchange");
    place.write("cube.toml", foggy_cube);
    std::string screened = squares;
    screened.insert(
        screened.rfind(" ]"),
        ",\n { name = \"screen\", material = \"grey\", rectangle = { corner = [0.2, 0.2, "
        "0.5], u = [0.3, 0, 0], v = [0, 0.3, 0] } }");
    place.write("screened.toml", screened);
    const auto refused = [&](const std::string& line, const std::vector<std::string>& words) {
        const auto outcome = place.run("exchange " + line);
        CAPTURE(line);
        CHECK(outcome.code == 1);
        CHECK(outcome.out == "");
        test::check_one_message(outcome);
        for (const auto& word : words) CHECK_THAT(outcome.err, Contains(word));
    };
    const std::string contour = " --method contour_integration";
    refused("cube.toml --from haze --to room.floor" + contour,
            {"haze", "room.floor+", "walked", "reference_pairs"});
    refused("cube.toml --from room.floor --to room.ceiling" + contour,
            {"room.floor+", "room.ceiling+", "medium", "uniform_transmittance"});
    refused("screened.toml --from low+ --to high+" + contour,
            {"low+", "high+", "in the way", "walked"});
    for (const std::string method : {"hemicube", "single_plane"})
        refused("cube.toml --from haze --method " + method, {"haze", "full_cube"});
    refused("cube.toml --method hemi", {"\"hemi\"", "hemicube", "walked"});
    refused("cube.toml --from flor", {"\"flor\"", "room.floor+"});
    CHECK(place.run("exchange cube.toml --tolerance 2").code == 2);
    CHECK(place.run("exchange").code == 2);
}

TEST_CASE("One transmittance a pair, if asked for") {
    const test::Workplace place("exchange");
    place.write("cube.toml", foggy_cube);
    const auto area = areas(printed(place,
                                    "cube.toml --from room.floor --to room.ceiling --method "
                                    "contour_integration --set solve.uniform_transmittance=true"));
    // The vacuum's figure times the transmittance of the metre between the middles.
    CHECK(area.at("room.floor+,room.ceiling+") ==
          Approx(0.199824895698387 * std::exp(-1.0)).epsilon(1e-12));
}

TEST_CASE("Smoothed tables close and are reciprocal; the raw errors are said beside") {
    const test::Workplace place("exchange");
    place.write("cube.toml", foggy_cube);
    const std::string line =
        "exchange cube.toml --rays 256 --set solve.smoothing=scaling --from haze --to room.floor";
    const auto outcome = place.run(line);
    REQUIRE(outcome.code == 0);
    CHECK(areas(outcome.out).size() == 1);
    CHECK_THAT(outcome.err, Contains("smoothing"));
    const auto json = nlohmann::json::parse(place.run(line + " --json").out);
    CHECK(json.at("closure_error").get<double>() < 1e-10);
    CHECK(json.at("reciprocity_error").get<double>() < 1e-10);
    CHECK(json.at("smoothing").at("raw_reciprocity_error").get<double>() > 1e-4);
}

TEST_CASE("Ctrl-C ends an exchange with one message and no file", "[long]") {
    const test::Workplace place("exchange");
    place.write("cube.toml", foggy_cube);
    // A tolerance that takes minutes.
    test::Running run(place.path, {"exchange", "cube.toml", "--method", "reference_pairs",
                                   "--tolerance", "1e-13", "-o", "areas.csv"});
    std::this_thread::sleep_for(std::chrono::seconds(1));
    run.signal(SIGINT);
    CHECK(test::exit_code(run.wait()) == 1);
    CHECK(!place.has("areas.csv"));
}
