// What users type about heat: fluxes, wavelengths, grey gases, and what comes out.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "cli/scene_file.h"
#include "cli/scene_spectrum.h"
#include "radiosity/adaptive.h"
#include "radiosity/report_json.h"
#include "radiosity/solution_file.h"
#include "support/catch.h"
#include "support/own_folder.h"

using namespace tyndall;
namespace fs = std::filesystem;

namespace {

const fs::path& folder = test::own_folder();
const fs::path gases = fs::path(TYNDALL_SOURCE_DIR) / "examples/scenes/gases";

cli::SceneFile read_heated(const std::string& text) {
    std::ofstream(folder / "scene.toml") << text;
    return cli::read_scene_file(folder / "scene.toml");
}

const std::string heated_room = R"(
[[surface]]
name = "room"
material = "wall"
room = { min = [0,0,0], max = [1,1,1] }
)";

std::string wall(const std::string& what) {
    return "\n[[material]]\nname = \"wall\"\nreflectance = 0.4\n" + what + "\n";
}

}  // namespace

TEST_CASE("A flux belongs to both sides, a value a band, or one for bands of wavelengths",
          "[heat]") {
    const auto grey = read_heated("format = 1\n" + wall("flux = -20.0") + heated_room);
    CHECK(grey.scene.materials[0].flux == radiosity::Spectrum{-20.0});
    CHECK(grey.scene.materials[0].emits == radiosity::EmittingSides::both);
    const auto each =
        read_heated("format = 1\nbands = 2\n" + wall("flux = [1.0, 2.0]") + heated_room);
    CHECK(each.scene.materials[0].flux == radiosity::Spectrum{1.0, 2.0});
    const auto all =
        read_heated("format = 1\nband_edges = [0, 3, inf]\n" + wall("flux = 5.0") + heated_room);
    CHECK(all.scene.materials[0].flux == radiosity::Spectrum{5.0});
}

TEST_CASE("Band edges make bands, in micrometres, to infinity", "[heat]") {
    const auto file = read_heated("format = 1\nband_edges = [0, 2.5, inf]\n" +
                                  wall("temperature = 1000") + heated_room);
    CHECK(file.scene.bands == 2);
    const auto& edges = file.scene.spectral.band_edges;
    REQUIRE(edges.size() == 3);
    CHECK(edges[0] == 0.0);
    CHECK(edges[1] == Approx(2.5e-6));
    CHECK(edges[2] == std::numeric_limits<double>::infinity());
    const auto& emission = file.scene.materials[0].emission;
    const double all = 0.6 * 56703.74419 / M_PI;
    CHECK(emission[0] == Approx(all * radiosity::planck_fraction(0.0025)));
    CHECK(emission[0] + emission[1] == Approx(all));
    // The scene that goes into solutions reads back.
    CHECK(read_heated(file.effective_toml).scene.spectral.band_edges == edges);
}

TEST_CASE("Grey gases: the files of the examples, and a medium of them beside soot", "[heat]") {
    const auto wet = cli::read_grey_gases(gases / "smith_1982_wet.toml");
    const auto equal = cli::read_grey_gases(gases / "smith_1982_equal.toml");
    REQUIRE(wet.gases.size() == 3);
    REQUIRE(equal.gases.size() == 3);
    // Total emissivity over 0.3 atm m at 1000 K: Hottel's charts have 0.3 to 0.35 for such
    // mixtures.
    for (const auto& [gas, expected] : {std::pair{&wet, 0.333}, {&equal, 0.302}}) {
        double emissivity = 0.0;
        for (std::size_t b = 1; b < gas->bands(); ++b)
            emissivity += radiosity::grey_gas_weight(*gas, b, 1000.0) *
                          -std::expm1(-gas->gases[b - 1].absorption * 0.3 * 101325.0);
        CHECK(emissivity == Approx(expected).margin(5e-4));
    }
    const auto file =
        read_heated("format = 1\ngrey_gases = \"" + (gases / "smith_1982_wet.toml").string() +
                    "\"\n" + wall("temperature = 500") + heated_room + R"(
[[medium]]
name = "flame"
partial_pressure = 20265
extinction = 0.5
albedo = 0.4
temperature = 1500
)");
    CHECK(file.scene.bands == 4);
    const auto& flame = file.scene.media[0];
    CHECK(flame.extinction[0] == Approx(0.5));
    CHECK(flame.extinction[2] == Approx(0.5 + 0.2 * 6.516));
    // What scatters stays, what absorbs is more.
    CHECK(flame.extinction[3] * flame.albedo[3] == Approx(0.2));
    double sum = 0.0;
    for (const double j : flame.emission) sum += j;
    CHECK(sum == Approx(5.670374419e-8 * std::pow(1500.0, 4) / M_PI));
    // 500 K is below what the weights are for.
    REQUIRE(file.notes.size() == 1);
    CHECK(file.notes[0].find("temperature 500 K of material \"wall\"") != std::string::npos);
}

TEST_CASE("Temperatures, net fluxes and settled emission survive files", "[heat]") {
    const auto file =
        read_heated("format = 1\nband_edges = [0, 4, inf]\n" + wall("flux = 0") + heated_room + R"(
[[material]]
name = "hot"
reflectance = 0.1
temperature = 1000
[[surface]]
name = "heater"
material = "hot"
rectangle = { corner = [0,0,0], u = [1,0,0], v = [0,1,0] }
[solve]
refinement = "none"
rays = 16
gather_rays = 16
)");
    const auto enclosure =
        std::make_shared<const radiosity::Enclosure>(radiosity::make_enclosure(file.scene));
    const auto solution = radiosity::solve_adaptively(enclosure, file.solve);
    // One wall has a temperature, all others are adiabatic: all are as hot.
    const auto& range = solution.report.temperature.at("room.ceiling+");
    CHECK(range.mean == Approx(1000.0).epsilon(0.01));
    CHECK(solution.report.net_flux.at("room.ceiling+").size() == 2);

    radiosity::write_solution(folder / "solution.vtkhdf", solution);
    const auto again = radiosity::read_solution(folder / "solution.vtkhdf").solution;
    CHECK(again.settled.patch == solution.settled.patch);
    CHECK(again.enclosure->thermal);
    CHECK(again.enclosure->spectral.band_edges == enclosure->spectral.band_edges);
    REQUIRE(again.enclosure->sides.size() == enclosure->sides.size());
    for (std::size_t s = 0; s < again.enclosure->sides.size(); ++s) {
        CHECK(again.enclosure->sides[s].emissivity == enclosure->sides[s].emissivity);
        CHECK(again.enclosure->sides[s].settled_flux == enclosure->sides[s].settled_flux);
    }
    CHECK(again.report.temperature.at("room.ceiling+").mean == range.mean);
    CHECK(again.report.net_flux == solution.report.net_flux);
    CHECK(radiosity::report_to_json(again.report, radiosity::Costs::left_out) ==
          radiosity::report_to_json(solution.report, radiosity::Costs::left_out));
}
