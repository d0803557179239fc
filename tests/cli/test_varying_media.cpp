// Extinction that varies in space, from the scene file to the solution file and back.
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "cli/expression.h"
#include "cli/scene_file.h"
#include "mesh/input_error.h"
#include "radiosity/enclosure.h"
#include "radiosity/solution_file.h"
#include "support/catch.h"
#include "support/program.h"

using namespace tyndall;

namespace {

std::string scene_with(const std::string& medium, int bands = 1) {
    return "format = 1\nbands = " + std::to_string(bands) + R"(
material = [ { name = "grey", reflectance = 0.5 }, { name = "lamp", reflectance = 0, emission = 5 } ]
surface  = [ { name = "room", material = "grey", room = { min = [0, 0, 0], max = [2, 2, 2] } },
             { name = "lamp", material = "lamp", rectangle = { corner = [0.5, 0.5, 2], u = [0, 1, 0], v = [1, 0, 0] } } ]
[[medium]]
name = "fog"
albedo = 0.8
)" + medium +
           "\n[solve]\nrefinement = \"none\"\nrays = 64\ngather_rays = 16\n";
}

radiosity::Enclosure enclosure_of(const test::Workplace& place, const std::string& medium,
                                  int bands = 1) {
    place.write("scene.toml", scene_with(medium, bands));
    return radiosity::make_enclosure(cli::read_scene_file(place.path / "scene.toml").scene);
}

}  // namespace

TEST_CASE("Expressions: values, names, operators") {
    const mesh::Point p(0.5, -2.0, 3.0);
    const auto value = [&](const char* text) { return cli::compile_expression(text)(p); };
    CHECK(value("0.3") == 0.3);
    CHECK(value("x + 10*y + 100*z") == 0.5 - 20.0 + 300.0);
    CHECK(value("2^z - -1") == 9.0);
    CHECK(value("y < 0 && z >= 3 ? 7 : 8") == 7.0);
    CHECK(value("max(0, min(x, z), y)") == 0.5);
    CHECK(value("exp(-z / 0.8)") == Approx(std::exp(-3.75)));
    CHECK(value("cos(pi) + ln(e)") == Approx(0.0).margin(1e-15));
    CHECK(value("abs(y) == 2 || x != 0.5") == 1.0);
    // Copies keep what they need.
    const auto copy = std::function(cli::compile_expression("x*z"));
    CHECK(copy({2, 0, 4}) == 8.0);
}

TEST_CASE("Extinction in a scene file: numbers, expressions, grids") {
    const test::Workplace place("varying");
    // A constant is the number, to the bit.
    const auto number = enclosure_of(place, "extinction = 0.3");
    const auto constant = enclosure_of(place, "extinction = \"0.1 + 0.2*1 + 0*x\"");
    CHECK(constant.media[0].varying.empty());
    CHECK(constant.media[0].extinction[0] == Approx(0.3).epsilon(1e-15));
    CHECK(enclosure_of(place, "extinction = \"0.3\"").media[0].extinction ==
          number.media[0].extinction);

    const auto fog = enclosure_of(place, "extinction = \"0.4 * exp(-z)\"");
    REQUIRE(fog.media[0].varying.size() == 1);
    CHECK(fog.media[0].varying[0].at({1, 1, 0.5}) == Approx(0.4 * std::exp(-0.5)).epsilon(2e-3));
    // Its mean over the room.
    CHECK(fog.media[0].extinction[0] == Approx(0.2 * (1.0 - std::exp(-2.0))).epsilon(2e-3));

    // The phase function reduces scattering: κ (1 − Ω g).
    const auto reduced =
        enclosure_of(place, "extinction = \"z\"\nphase = { henyey_greenstein = 0.5 }");
    CHECK(reduced.media[0].varying[0].at({1, 1, 1}) == Approx(0.6));
    CHECK(reduced.media[0].albedo[0] == Approx(0.4 / 0.6));

    const auto bands = enclosure_of(place, "extinction = [\"x\", 0.5, \"x\"]", 3);
    REQUIRE(bands.media[0].varying.size() == 3);
    CHECK(bands.media[0].varying[0].at({1.5, 1, 1}) == Approx(1.5));
    CHECK(bands.media[0].varying[1].at({1.5, 1, 1}) == 0.5);

    // The broken scenes' good grid: values k/59 of the array [3, 4, 5] in C order.
    const std::string file = TYNDALL_SOURCE_DIR "/tests/broken/smoke.npy";
    const auto grid = enclosure_of(place,
                                   "extinction = { file = \"" + file +
                                       "\", min = [0, 0, 0], max = [2, 2, 1], scale = [1, 2, 4] }",
                                   3);
    REQUIRE(grid.media[0].varying.size() == 3);
    CHECK(grid.media[0].varying[1].at({1, 0, 0}) == Approx(2.0 * 20.0 / 59.0));
    CHECK(grid.media[0].varying[2].at({0, 2, 0.25}) == Approx(4.0 * 16.0 / 59.0));
    CHECK(grid.media[0].varying[0].at({1, 1, 1.5}) == 0.0);
}

TEST_CASE("A varying medium is kept in the solution file, and seen from it alone") {
    const test::Workplace place("varying_file");
    place.write("scene.toml", scene_with("extinction = [\"exp(-z)\", \"0.5*exp(-z)\", 0.2]", 3));
    const auto solved = place.run("solve scene.toml -o out");
    INFO(solved.err);
    REQUIRE(solved.code == 0);
    const auto read = radiosity::read_solution(place.path / "out" / "solution.vtkhdf");
    const auto made =
        radiosity::make_enclosure(cli::read_scene_file(place.path / "scene.toml").scene);
    REQUIRE(read.solution.enclosure->media[0].varying.size() == 3);
    for (std::size_t b = 0; b < 3; ++b) {
        const auto &a = read.solution.enclosure->media[0].varying[b], &c = made.media[0].varying[b];
        CHECK(a.factor == c.factor);
        CHECK(a.shape->counts() == c.shape->counts());
        CHECK(a.shape->values() == c.shape->values());
        CHECK(a.shape->low() == c.shape->low());
        CHECK(a.shape->beyond() == c.shape->beyond());
    }
    place.write("points.csv", "x,y,z\n1,1,0.5\n");
    const auto probed = place.run("probe out --points points.csv");
    INFO(probed.err);
    CHECK(probed.code == 0);
}

TEST_CASE("Methods that need one extinction a medium refuse, and name those that do not") {
    const test::Workplace place("varying_methods");
    place.write("scene.toml", scene_with("extinction = \"0.1 + z\""));
    for (const std::string method : {"full_cube", "reference_pairs", "contour_integration"}) {
        const auto outcome = place.run("exchange scene.toml --method " + method);
        CHECK(outcome.code == 1);
        CHECK_THAT(outcome.err, Contains("\"" + method + "\" needs one extinction a medium") &&
                                    Contains("\"fog\" varies in space") &&
                                    Contains("Set exchange to walked"));
    }
    const auto walked = place.run("exchange scene.toml --from fog --to fog");
    INFO(walked.err);
    CHECK(walked.code == 0);
    const auto solve = place.run("solve scene.toml -o out --set solve.exchange=full_cube");
    CHECK(solve.code == 1);
    CHECK_THAT(solve.err, Contains("needs one extinction a medium"));
}
