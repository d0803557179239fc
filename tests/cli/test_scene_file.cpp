#include "cli/scene_file.h"

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "mesh/input_error.h"
#include "support/catch.h"

using namespace tyndall;
namespace fs = std::filesystem;

namespace {

const std::string material = R"(
[[material]]
name = "plaster"
reflectance = 0.5
)";

const std::string grey_room = R"(
[[surface]]
name = "room"
material = "plaster"
room = { min = [0, 0, 0], max = [4, 3, 2] }
)";

// Reads a scene from text; the file is removed.
cli::SceneFile read(const std::string& text, const std::vector<std::string>& overrides = {}) {
    const fs::path path =
        fs::temp_directory_path() / ("tyndall_scene_" + std::to_string(::getpid()) + ".toml");
    std::ofstream(path) << text;
    struct Remove {
        const fs::path& path;
        ~Remove() { fs::remove(path); }
    } remove{path};
    return cli::read_scene_file(path, overrides);
}

std::string message_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
    try {
        read(text, overrides);
    } catch (const mesh::InputError& error) {
        return error.what();
    }
    return "";
}

const radiosity::Surface& surface(const cli::SceneFile& file, const std::string& name) {
    for (const auto& s : file.scene.surfaces) {
        if (s.name == name) return s;
    }
    FAIL("no surface " << name);
    return file.scene.surfaces.front();
}

glm::dvec3 area_vector(const mesh::Polygon& polygon) {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 1; i + 1 < polygon.corners.size(); ++i) {
        sum += 0.5 * glm::cross(polygon.corners[i] - polygon.corners[0],
                                polygon.corners[i + 1] - polygon.corners[0]);
    }
    return sum;
}

glm::dvec3 area_vector(const radiosity::Surface& s) {
    glm::dvec3 sum(0.0);
    for (const auto& polygon : s.polygons) sum += area_vector(polygon);
    return sum;
}

bool holds(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("The window-shafts scene is the room with six openings, a box and a lamp") {
    const auto file =
        cli::read_scene_file(fs::path(TYNDALL_SOURCE_DIR) / "examples/scenes/window_shafts.toml");
    CHECK(file.scene.title == "Window shafts");
    CHECK(file.scene.bands == 1);
    REQUIRE(file.scene.surfaces.size() == 6 + 6 + 6 + 1);
    // x0 without its openings: 4 × 3 m less six of 0.5 × 0.5 m, front towards +x.
    const auto wall = area_vector(surface(file, "room.x0"));
    CHECK(wall.x == Approx(12.0 - 6 * 0.25));
    CHECK(std::abs(wall.y) + std::abs(wall.z) < 1e-12);
    const auto& slit = surface(file, "room.high_right");
    CHECK(!slit.material);
    CHECK(slit.polygons.at(0).opacity == mesh::Opacity::interface);
    CHECK(glm::length(area_vector(slit)) == Approx(0.25));
    // The lamp: 0.4 × 0.4 m, normal towards the windows.
    const auto lamp = area_vector(surface(file, "emitter"));
    CHECK(glm::length(lamp) == Approx(0.16));
    CHECK(lamp.x / glm::length(lamp) == Approx(0.7761140001162655));
    CHECK(lamp.z / glm::length(lamp) == Approx(-0.6305926250944657));
    const auto& emitter = file.scene.materials.at(*surface(file, "emitter").material);
    CHECK(emitter.emission == radiosity::Spectrum{2000.0});
    CHECK(emitter.emits == radiosity::EmittingSides::front);
    REQUIRE(file.scene.media.size() == 1);
    CHECK(file.scene.media[0].extinction == radiosity::Spectrum{0.15});
    CHECK(file.scene.media[0].albedo == radiosity::Spectrum{1.0});
    REQUIRE(file.cameras.size() == 1);
    CHECK(file.view_camera == "main");
    CHECK(*file.cameras[0].fov_x == Approx(75.0 * std::numbers::pi / 180.0));
    CHECK(file.cameras[0].width == 320);
    CHECK(file.scene.viewpoints.at(0) == file.cameras[0].eye);
    CHECK(file.notes.empty());
}

TEST_CASE("All example scenes are read without notes") {
    std::size_t count = 0;
    for (const auto& entry :
         fs::directory_iterator(fs::path(TYNDALL_SOURCE_DIR) / "examples/scenes")) {
        if (entry.path().extension() != ".toml") continue;
        INFO(entry.path().string());
        ++count;
        CHECK(cli::read_scene_file(entry.path()).notes.empty());
    }
    CHECK(count >= 4);
}

TEST_CASE("A scalar holds for all bands") {
    const auto file = read("format = 1\nbands = 3\n" + material + R"(
[[material]]
name = "red"
reflectance = [0.7, 0.1, 0.05]
exitance = [3.0, 2.0, 1.0]
)" + grey_room);
    CHECK(file.scene.materials[0].reflectance == radiosity::Spectrum{0.5, 0.5, 0.5});
    CHECK(file.scene.materials[1].reflectance == radiosity::Spectrum{0.7, 0.1, 0.05});
    CHECK(file.scene.materials[1].emission[0] == Approx(3.0 / std::numbers::pi));
}

TEST_CASE("Temperature becomes radiance: (1 - rho) sigma T^4 / pi, from both sides") {
    const auto file = read("format = 1\n" + material + "temperature = 1000.0\n" + grey_room + R"(
[[medium]]
name = "gas"
extinction = 0.5
temperature = 1000.0
)");
    const double black = 5.670374419e-8 * 1e12 / std::numbers::pi;  // CODATA 2018
    CHECK(file.scene.materials[0].emission.at(0) == Approx(0.5 * black));
    CHECK(file.scene.materials[0].emits == radiosity::EmittingSides::both);
    CHECK(file.scene.media[0].emission.at(0) == Approx(black));
}

TEST_CASE("Lights: degrees become radians, directions unit length, a target an axis") {
    const auto file = read("format = 1\n" + material + grey_room + R"(
[[light]]
name = "sun"
sun = { direction = [0, 3, -4], irradiance = 800, angle = 0.53 }

[[light]]
name = "spot"
spot = { position = [1, 1, 2], target = [1, 1, 0], intensity = 50, angle = 30, soft_edge = 5 }

[[light]]
name = "bulb"
point = { position = [1, 1, 1], intensity = 5 }
)");
    const auto& sun = std::get<radiosity::Sun>(file.scene.lights.at(0).source);
    CHECK(sun.direction == glm::dvec3(0, 0.6, -0.8));
    CHECK(sun.angle == Approx(0.53 * std::numbers::pi / 180.0));
    const auto& spot = std::get<radiosity::SpotLight>(file.scene.lights.at(1).source);
    CHECK(spot.direction == glm::dvec3(0, 0, -1));
    CHECK(spot.angle == Approx(std::numbers::pi / 6));
    CHECK(std::get<radiosity::PointLight>(file.scene.lights.at(2).source).intensity.at(0) == 5.0);
}

TEST_CASE("Scale, rotation and translation are applied in this order") {
    const auto file = read("format = 1\n" + material + R"(
[[surface]]
name = "part"
material = "plaster"
rectangle = { corner = [0, 0, 0], u = [1, 0, 0], v = [0, 1, 0] }
scale = [2, 3, 1]
rotate = { axis = [0, 0, 5], degrees = 90 }
translate = [10, 0, 1]
)");
    const auto& corners = file.scene.surfaces[0].polygons[0].corners;
    // (1, 0, 0) → (2, 0, 0) → (0, 2, 0) → (10, 2, 1); quarter turns are exact.
    CHECK(corners[0] == mesh::Point(10, 0, 1));
    CHECK(corners[1] == mesh::Point(10, 2, 1));
    CHECK(corners[3] == mesh::Point(7, 0, 1));
    CHECK(area_vector(file.scene.surfaces[0]).z == Approx(6.0));
}

TEST_CASE("A mirror image keeps its fronts") {
    const auto file = read("format = 1\n" + material + R"(
[[surface]]
name = "box"
material = "plaster"
box = { min = [0, 0, 0], max = [1, 1, 1] }
scale = [-1, 1, 1]
)");
    double volume = 0.0;  // by the divergence theorem, positive where fronts look outward
    for (const auto& s : file.scene.surfaces) {
        volume += glm::dot(s.polygons[0].corners[0], area_vector(s)) / 3.0;
    }
    CHECK(volume == Approx(1.0));
}

TEST_CASE("A surface without material is an interface") {
    const auto file = read("format = 1\n" + material + grey_room + R"(
[[surface]]
name = "fog_bank"
box = { min = [1, 1, 0.5], max = [2, 2, 1] }
)");
    CHECK(!surface(file, "fog_bank.top").material);
    CHECK(surface(file, "fog_bank.top").polygons[0].opacity == mesh::Opacity::interface);
    CHECK(surface(file, "room.floor").polygons[0].opacity == mesh::Opacity::opaque);
}

TEST_CASE("Settings are read; a size may have a unit; the seed is the picture's too") {
    const auto file = read("format = 1\n" + material + grey_room + R"(
[solve]
error = 0.003
refinement = "uniform"
direct_light = "rows"
max_memory = "1.5 GiB"
max_elements = 1e6
seed = 7
camera = ""
[render]
samples = 4
white = 12
)");
    CHECK(file.solve.error == 0.003);
    CHECK(file.solve.refinement == radiosity::Refinement::uniform);
    CHECK(file.solve.direct_light == radiosity::DirectLightMode::rows);
    CHECK(file.solve.max_memory == 1610612736);
    CHECK(file.solve.max_elements == 1000000);
    CHECK(file.render.seed == 7);
    CHECK(file.render.samples == 4);
    CHECK(*file.tone_map.white == 12.0);
    CHECK(file.view_camera == "");
}

TEST_CASE("the flag --set edits any key; its value is TOML, or a word") {
    const std::string text = "format = 1\n" + material + grey_room + R"(
[[light]]
name = "sun"
sun = { direction = [0, 0, -1], irradiance = 800 }
)";
    const auto file = read(
        text, {"material.plaster.reflectance=0.3", "solve.error=0.003", "solve.refinement=none",
               "light.sun.sun.irradiance=500", "environment.radiance = 1", "bands=3",
               "title=A title", "surface.room.translate=[0, 0, 1]", "solve.max_memory=2 GB"});
    CHECK(file.scene.bands == 3);
    CHECK(file.scene.materials[0].reflectance == radiosity::Spectrum{0.3, 0.3, 0.3});
    CHECK(file.solve.error == 0.003);
    CHECK(file.solve.refinement == radiosity::Refinement::none);
    CHECK(file.solve.max_memory == 2000000000);
    CHECK(std::get<radiosity::Sun>(file.scene.lights[0].source).irradiance[2] == 500.0);
    CHECK(file.scene.environment == radiosity::Spectrum{1, 1, 1});
    CHECK(file.scene.title == "A title");
    CHECK(surface(file, "room.floor").polygons[0].corners[0].z == 1.0);

    // The effective scene reads back the same, and prints the same.
    const auto again = read(file.effective_toml);
    CHECK(again.effective_toml == file.effective_toml);
    CHECK(again.scene.materials[0].reflectance == file.scene.materials[0].reflectance);
    CHECK(again.solve.max_memory == file.solve.max_memory);
}

TEST_CASE("the flag --set reaches into openings and quoted names") {
    const std::string text = "format = 1\n" + material + R"(
[[surface]]
name = "my wall"
material = "plaster"
rectangle = { corner = [0, 0, 0], u = [4, 0, 0], v = [0, 3, 0], openings = [ { name = "slit", corner = [1, 1], size = [1, 1] } ] }
)";
    const auto file = read(text, {"surface.\"my wall\".rectangle.openings.slit.size=[2, 1]"});
    CHECK(area_vector(surface(file, "my wall.slit")).z == Approx(2.0));
    CHECK(area_vector(surface(file, "my wall")).z == Approx(10.0));
}

TEST_CASE("A broken --set is refused, with itself as the place") {
    const std::string text = "format = 1\n" + material + grey_room;
    struct Case {
        std::string override, part;
    };
    const std::vector<Case> cases{
        {"solve.error", "there is no '='"},
        {"=5", "a key is empty"},
        {"solve..error=5", "a key is empty"},
        {"solve.error=0", "error 0 of [solve] is not a value above 0"},
        {"solve.error=nan", "is not finite"},
        {"solve.error=[1", "is not valid TOML"},
        {"solve.error=1\nbands=3", "is not valid TOML"},
        {"solve.error=0.1.2", "error of [solve] is a string (\"0.1.2\")"},
        {"solve.eror=0.1", "unknown key \"eror\" in [solve]. Did you mean \"error\"?"},
        {"slove.error=0.1", "unknown key \"slove\" in the scene. Did you mean \"solve\"?"},
        {"material.plastr.reflectance=0.1",
         "there is no material named \"plastr\". There is: plaster."},
        {"material.plaster.reflectence=0.1", "Did you mean \"reflectance\"?"},
        {"material.plaster=0.1", "material is an array"},
        {"material.plaster.reflectance.red=0.1", "which has no keys"},
        {"medium.haze.albedo=1", "the file has no medium"},
        {"camera.main.width=320", "the file has no camera"},
        {"surface.room.room.min=[0, 0]", "min of room of surface \"room\" has 2 values"},
        {"bands=0", "bands 0 of the scene is outside 1 to 64"},
        {"solve.indicators=[\"jmup\"]",
         "an element of indicators of [solve] is \"jmup\", which is not one of: direct, "
         "shadow_boundary, indirect, jump or optical_thickness. Did you mean \"jump\"?"},
        {"solve.indicators=[1]", "an element of indicators of [solve] is an integer (1)"},
        {"solve.indicators=direct", "indicators of [solve] is a string (\"direct\")"},
        {"solve.optical_thickness=0", "optical_thickness 0 of [solve] is not a value above 0"},
    };
    for (const Case& c : cases) {
        const std::string message = message_of(text, {c.override});
        INFO(message);
        CHECK(message.rfind("--set " + c.override + ": ", 0) == 0);
        CHECK(holds(message, c.part));
    }
}

TEST_CASE("Mirrors are walked where the exchange method can") {
    using radiosity::Mirrors;
    const std::string glass = "format = 1\n" + material + "specular = 0.3\n" + grey_room;
    CHECK(read(glass).mirrors == Mirrors::walked);
    CHECK(read(glass, {"solve.mirrors=scattered"}).mirrors == Mirrors::scattered);
    const auto cubes = read(glass, {"solve.exchange=full_cube"});
    CHECK(cubes.mirrors == Mirrors::scattered);
    REQUIRE(cubes.notes.size() == read(glass).notes.size() + 1);
    CHECK(holds(cubes.notes.back() + cubes.notes.front(), "\"full_cube\" does not follow mirrors"));
    // Nobody needs to be told of mirrors that are not there, or that are rough.
    const std::string plain = "format = 1\n" + material + grey_room;
    CHECK(read(plain, {"solve.exchange=full_cube"}).notes == read(plain).notes);
    CHECK(read(glass, {"solve.exchange=full_cube", "material.plaster.roughness=0.2"}).notes ==
          read(glass).notes);
}

TEST_CASE("Indicators are chosen by name, from the file or by --set") {
    const std::string text = "format = 1\n" + material + grey_room;
    CHECK(read(text).solve.indicators ==
          std::vector<std::string>{"direct", "shadow_boundary", "indirect"});
    const auto file = read(text, {"solve.indicators=[\"jump\", \"optical_thickness\"]",
                                  "solve.optical_thickness=0.25"});
    CHECK(file.solve.indicators == std::vector<std::string>{"jump", "optical_thickness"});
    CHECK(file.solve.optical_thickness == 0.25);
    CHECK(read(text, {"solve.indicators=[]"}).solve.indicators.empty());
    // The place is that of the name within the array.
    const std::string message =
        message_of(text + "[solve]\nindicators = [\"direct\", \"shadow\"]\n");
    INFO(message);
    CHECK(holds(message, ":25: an element of indicators"));
    CHECK(holds(message, "Did you mean \"shadow_boundary\"?"));
}

TEST_CASE("The reference of keys has every table and no empty type") {
    const std::string text = cli::scene_file_reference();
    for (const std::string part : {"[[material]]", "henyey_greenstein", "max_memory", "soft_edge",
                                   "face", "exposure", "fov_x", "degrees"}) {
        CHECK(holds(text, part));
    }
    CHECK(!holds(text, "` |  |"));
}

TEST_CASE("The defaults that the reference names are those of the structs") {
    const auto plain = read("format = 1\n" + material + grey_room);
    std::istringstream text(cli::scene_file_reference());
    std::string line, table;
    std::size_t checked = 0;
    while (std::getline(text, line)) {
        if (line.starts_with("### ")) table = line.substr(4);
        if ((table != "[solve]" && table != "[render]") || !line.starts_with("| `")) continue;
        // | `key` | type | default | meaning |
        std::vector<std::string> cells;
        std::istringstream row(line);
        for (std::string cell; std::getline(row, cell, '|');) cells.push_back(cell);
        REQUIRE(cells.size() == 5);
        const std::string key = cells[1].substr(2, cells[1].size() - 4);
        const std::string fallback = cells[3].substr(1, cells[3].size() - 2);
        // What no value of the key says: none, or something that is found in the scene.
        const bool in_scene = key == "camera" || key == "mesh" || key == "white";
        const bool follows_another = fallback == "solve.seed";
        if (in_scene || follows_another) continue;
        CAPTURE(table, key, fallback);
        const auto file = read("format = 1\n" + material + grey_room + table + "\n" + key + " = " +
                               fallback + "\n");
        CHECK(file.solve == plain.solve);
        CHECK(file.render == plain.render);
        CHECK(file.tone_map == plain.tone_map);
        ++checked;
    }
    CHECK(checked >= 20);
    CHECK(plain.solve == radiosity::SolveOptions());
    CHECK(plain.render == render::RenderOptions());
    CHECK(plain.tone_map == render::ToneMapOptions());
}
