// What `tyndall check` tells: what will be solved, and what it will take.

#include <nlohmann/json.hpp>

#include "cli/forecast.h"
#include "cli/solve_in_words.h"
#include "support/catch.h"
#include "support/program.h"

namespace {

using namespace tyndall;

// A closed box of 2 m, a lamp on its ceiling, fog.
const std::string box = R"(format = 1
material = [ { name = "grey", reflectance = 0.5 }, { name = "lamp", reflectance = 0, emission = 10 } ]
surface = [ { name = "box", material = "grey", room = { min = [0, 0, 0], max = [2, 2, 2] } },
            { name = "light", material = "lamp", polygons = [ [[0.8, 0.8, 2], [0.8, 1.2, 2], [1.2, 1.2, 2], [1.2, 0.8, 2]] ] } ]
medium = [ { name = "fog", extinction = 0.6, albedo = 0.5 } ]
camera = [ { name = "main", eye = [1.8, 0.2, 1], target = [0, 2, 1], fov_y = 60, width = 32, height = 24 } ]
solve = { error = 0.2, element_size = 0.5, rays = 32, gather_rays = 32 }
)";

struct CheckWorkplace : test::Workplace {
    CheckWorkplace() : test::Workplace("check") { write("box.toml", box); }

    nlohmann::json checked(const std::string& more = "") const {
        return nlohmann::json::parse(good("check box.toml --json " + more));
    }
    cli::SceneFile scene() const { return cli::read_scene_file(path / "box.toml"); }
};

}  // namespace

TEST_CASE("check says in words what will be solved") {
    const CheckWorkplace place;
    const auto text = place.good("check box.toml --no-forecast");
    CHECK_THAT(text, Contains("camera \"main\"") && Contains("along the edges of shadows") &&
                         Contains("20 % estimated error of the picture") &&
                         Contains("walked, 32 rays an element") && Contains("gmres") &&
                         Contains("32 x 24") && Contains("1, grey"));
    const auto furnace = place.good(
        "check box.toml --no-forecast --set solve.camera= --set solve.start=base --set "
        "solve.element_size=0 --set "
        "solve.direct_light=rows --set solve.exchange=hemicube --set bands=3");
    CHECK_THAT(furnace, Contains("solution everywhere") && Contains("base tetrahedra") &&
                            Contains("through the exchange areas") && Contains("hemicube") &&
                            Contains("bands    3"));
    CHECK_THAT(place.good("check box.toml --no-forecast --set solve.refinement=uniform"),
               Contains("kept as they are"));
}

TEST_CASE("optical thickness is that along the mean chord 4V/S") {
    const CheckWorkplace place;
    const auto file = place.scene();
    const auto media = cli::media_thickness(radiosity::make_enclosure(file.scene));
    REQUIRE(media.size() == 1);
    CHECK(media[0].chord == Approx(4.0 * 8.0 / 24.0).epsilon(1e-9));
    CHECK(media[0].thickest == Approx(0.6 * 4.0 / 3.0).epsilon(1e-9));
    CHECK(media[0].albedo == Approx(0.5));
    CHECK_THAT(cli::in_words(media[0]), Contains("moderate") && Contains("0.8"));
    CHECK_THAT(cli::in_words({"air", 2.0, 0.0, 0.0, 0.0}), Contains("clear"));
    CHECK_THAT(cli::in_words({"soot", 2.0, 1.0, 40.0, 0.1}), Contains("very thick"));
}

TEST_CASE("both sides of a partition, and an interface, end a medium's chords") {
    const CheckWorkplace place;
    auto text = box;
    text.insert(text.find("{ name = \"light\""),
                "{ name = \"half\", rectangle = { corner = [1, 0, 0], u = [0, 2, 0], v = [0, 0, 2] "
                "} }, ");
    text.replace(text.find("albedo = 0.5 }"), 14, "albedo = 0.5, at = [0.5, 1, 1] }");
    place.write("box.toml", text);
    const auto file = place.scene();
    const auto media = cli::media_thickness(radiosity::make_enclosure(file.scene));
    REQUIRE(media.size() == 1);
    CHECK(media[0].chord == Approx(4.0 * 4.0 / (4.0 * 2.0 + 2.0 * 4.0)).epsilon(1e-9));
}

TEST_CASE("a forecast holds what is asked for", "[long]") {
    const CheckWorkplace place;
    const auto coarse = place.checked().at("forecast");
    const auto fine = place.checked("--set solve.error=0.02 --set solve.rays=256").at("forecast");
    CHECK(coarse["elements"] >= coarse["start_elements"]);
    CHECK(fine["elements"] > coarse["elements"]);
    CHECK(fine["memory_bytes"] > coarse["memory_bytes"]);
    for (const auto* key : {"solve_cpu_seconds", "picture_cpu_seconds", "wall_seconds"})
        CHECK(fine[key].get<double>() > 0.0);
    const auto limited =
        place.checked("--set solve.error=0.001 --set solve.max_elements=7000").at("forecast");
    CHECK(limited["limited"] == true);
    CHECK(limited["elements"] <= 7000);
    CHECK_FALSE(place.checked("--no-forecast").contains("forecast"));
    CHECK_THAT(place.good("check box.toml"), Contains("elements about") && Contains("of CPU"));
}

TEST_CASE("elements are foreseen within a factor of two", "[long]") {
    const CheckWorkplace place;
    // Example scenes are within 25 % (docs/validation.md); this is one
    // that the growth was not fitted to.
    const auto foreseen = place.checked("--set solve.error=0.02").at("forecast");
    const auto solved =
        nlohmann::json::parse(place.good("solve box.toml -o out --json --set solve.error=0.02"));
    const double found = solved["patches"].get<double>() + solved["zones"].get<double>();
    CHECK(foreseen["elements"].get<double>() > 0.5 * found);
    CHECK(foreseen["elements"].get<double>() < 2.0 * found);
    CHECK(foreseen["start_elements"] == solved["solved_elements"]);
}
