// tyndall export: formats by name, what goes with each, and what is refused.
#include <nlohmann/json.hpp>

#include "support/catch.h"
#include "support/foggy_box.h"
#include "support/occurrences.h"
#include "support/program.h"

using namespace tyndall;
using Json = nlohmann::json;

namespace {

std::string export_complaint(const test::Workplace& place, const std::string& arguments) {
    CAPTURE(arguments);
    const auto outcome = place.run(arguments);
    CHECK(outcome.code == 1);
    CHECK(outcome.out == "");
    test::check_one_message(outcome);
    return outcome.err;
}

}  // namespace

TEST_CASE("export writes every format of a solution, by the file's name", "[export]") {
    const test::Workplace place("export");
    place.write("box.toml", test::foggy_box);
    place.good("solve box.toml -o out --quiet");
    const auto report = Json::parse(place.read("out/report.json"));
    CHECK_THAT(place.good("export out -o out/room.vtu"), Contains("wrote    out/room.vtu (vtu"));
    CHECK_THAT(
        place.read("out/room.vtu"),
        Contains("NumberOfCells=\"" +
                 std::to_string(report["patches"].get<int>() + report["zones"].get<int>()) + "\""));
    place.good("export out/solution.vtkhdf -o room.ply");
    CHECK_THAT(place.read("room.ply"),
               Contains("element face " + std::to_string(report["patches"].get<int>())));
    const auto made = Json::parse(place.good("export out -o room.obj --json"));
    CHECK(made["format"] == "obj");
    CHECK(made["files"] == 2);
    CHECK(made["bytes"] == place.read("room.obj").size() + place.read("room.mtl").size());
    // Another name, and the format by hand.
    place.good("export out --format ply -o dark.bin --set render.exposure=-2");
    CHECK(place.read("dark.bin").size() == place.read("room.ply").size());
    CHECK(place.read("dark.bin") != place.read("room.ply"));
}

TEST_CASE("export makes the same room of a scene and of its solution", "[export]") {
    const test::Workplace place("export_room");
    place.write("box.toml", test::foggy_box);
    place.good("solve box.toml -o out --quiet");
    for (const std::string name : {"room.xml", "room.pbrt", "room.msh"}) {
        place.good("export box.toml --quiet -o " + name);
        const auto of_scene = place.read(name);
        place.good("export out --quiet -o " + name);
        CHECK(place.read(name) == of_scene);
    }
    // Parts lie beside the file that names them.
    place.good("export box.toml -o deep/er.xml");
    CHECK_THAT(place.read("deep/er.xml"), Contains("\"er_parts/room_floor.ply\""));
    CHECK(place.has("deep/er_parts/room_floor.ply"));
    CHECK(test::occurrences(place.read("room.xml"), "<sensor") == 2);
    place.good("export box.toml -o side.xml --camera side --samples 7");
    const auto side = place.read("side.xml");
    CHECK(test::occurrences(side, "<sensor") == 1);
    CHECK_THAT(side, Contains("camera_side") && Contains("sample_count\" value=\"7\""));
    CHECK_THAT(place.good("export box.toml -o two.pbrt"),
               Contains("note     pbrt has one camera a file: this is \"main\""));
    // --set reaches the scene.
    place.good("export box.toml -o thick.xml --set medium.fog.extinction=3");
    CHECK_THAT(place.read("thick.xml"), Contains("name=\"scale\" value=\"3\""));
}

TEST_CASE("A mesh that was exported is a base mesh to solve on", "[export]") {
    const test::Workplace place("export_mesh");
    place.write("box.toml", test::foggy_box);
    place.good("export box.toml -o room.msh");
    const auto own = Json::parse(place.good("check box.toml --json"));
    const auto read = Json::parse(place.good(
        "check box.toml --json --set 'solve.start=\"mesh\"' --set 'solve.mesh=\"room.msh\"'"));
    CHECK(read["tetrahedra"] == own["tetrahedra"]);
    CHECK(read["media"] == own["media"]);
    CHECK(read["warnings"] == own["warnings"]);  // nothing was welded, turned or filled
}

TEST_CASE("export says what is wrong", "[export]") {
    const test::Workplace place("export_wrong");
    place.write("box.toml", test::foggy_box);
    CHECK_THAT(
        export_complaint(place, "export box.toml -o room.stl"),
        Contains("'room.stl'") && Contains(".vtu (vtu), .msh (gmsh)") && Contains("--format"));
    CHECK_THAT(export_complaint(place, "export box.toml -o room.x --format blender"),
               Contains("there is no format \"blender\"") && Contains("mitsuba, pbrt"));
    CHECK_THAT(export_complaint(place, "export box.toml -o room.vtu"),
               Contains("'box.toml' is a scene") && Contains("tyndall run box.toml"));
    CHECK_THAT(export_complaint(place, "export box.toml -o room.msh --samples 4"),
               Contains("--camera, --band and --samples are of mitsuba and pbrt"));
    CHECK_THAT(export_complaint(place, "export box.toml -o room.xml --camera top"),
               Contains("there is no camera \"top\""));
    CHECK_THAT(export_complaint(place, "export box.toml -o room.xml --band 1"),
               Contains("--band 1: the scene has the bands 0 to 0"));
    CHECK_THAT(export_complaint(place, "export nowhere -o room.vtu"), Contains("nowhere"));
    CHECK_THAT(export_complaint(place, "export box.toml -o box.toml/room.xml"),
               Contains("box.toml"));
    CHECK(place.run("export box.toml").code == 2);
    CHECK(!place.has("room.xml"));
}
