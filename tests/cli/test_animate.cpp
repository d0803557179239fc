// Scenes whose keys change in time.
#include <signal.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "cli/animation_plan.h"
#include "cli/scene_file.h"
#include "support/catch.h"
#include "support/program.h"

using namespace tyndall;
using Json = nlohmann::json;

namespace {

// A small foggy room with a lamp and a sun, solved to little.
const std::string animated_room = R"(
format = 1
material = [ { name = "grey", reflectance = 0.5 },
             { name = "lamp", reflectance = 0.0, emission = 10.0 } ]
surface = [ { name = "room", material = "grey", room = { min = [0, 0, 0], max = [2, 2, 2], openings = [ { name = "window", face = "x0", corner = [0.5, 0.5], size = [1, 1] } ] } },
            { name = "lamp", material = "lamp", rectangle = { corner = [0.5, 0.5, 2], u = [0, 1, 0], v = [1, 0, 0] } } ]
medium = [ { name = "haze", extinction = 0.5, albedo = 0.8, at = [1, 1, 1] } ]
light = [ { name = "sun", sun = { direction = [1, 0.2, -0.5], irradiance = 20.0 } } ]
camera = [ { name = "main", eye = [1.9, 0.1, 1.2], target = [0, 2, 0.8], fov_y = 60, width = 16, height = 16 } ]
solve = { error = 0.2, rays = 16, gather_rays = 16, element_size = 1.0, max_elements = 2000 }
render = { samples = 4 }
)";

std::string track(const std::string& key, const std::string& rest) {
    return "[[animation.track]]\nkey = \"" + key + "\"\n" + rest + "\n";
}

const std::string lamp = track("material.lamp.emission", "frames = [0, 5]\nvalues = [10, 0]");

// "solved kept kept …" of the frames there are.
std::string done(const test::Workplace& place, const std::string& folder) {
    std::string text;
    const auto report = Json::parse(place.read(folder + "/report.json"));
    for (const auto& frame : report.at("frames"))
        text += (text.empty() ? "" : " ") + frame.at("done").get<std::string>();
    return text;
}

std::string values_of(const std::string& tracks, std::size_t frame) {
    const test::Workplace place("animation_values");
    place.write("room.toml", animated_room + "[animation]\nframes = 11\nfps = 10\n" + tracks);
    const auto file = cli::read_scene_file(place.path / "room.toml");
    std::string text;
    for (const auto& setting : cli::settings_of_frame(*file.animation, frame))
        text += (text.empty() ? "" : " ") + setting.value;
    return text;
}

}  // namespace

TEST_CASE("Tracks hold outside their keyframes and run straight, smooth or in steps between",
          "[animate]") {
    const std::string keyframes = "frames = [2, 6]\nvalues = [1, 9]\n";
    const auto emission = [&](const std::string& rest, std::size_t frame) {
        return values_of(track("material.lamp.emission", keyframes + rest), frame);
    };
    CHECK(emission("", 0) == "1");
    CHECK(emission("", 3) == "3");
    CHECK(emission("", 10) == "9");
    CHECK(emission("interpolation = \"smooth\"", 3) == "2.25");  // 1 + 8 (3 t² − 2 t³), t = 1/4
    CHECK(emission("interpolation = \"step\"", 5) == "1");
    CHECK(emission("interpolation = \"step\"", 6) == "9");
    // In seconds, at 10 frames a second; arrays by their elements; strings.
    CHECK(values_of(
              track("light.sun.sun.direction", "times = [0, 1]\nvalues = [[1, 0, -1], [0, 1, -1]]"),
              5) == "[0.5, 0.5, -1]");
    CHECK(values_of(track("material.lamp.emits",
                          "frames = [0, 4]\nvalues = [\"front\", \"both\"]\n"
                          "interpolation = \"step\""),
                    4) == "\"both\"");
}

TEST_CASE("What changes decides what is done anew", "[animate]") {
    const test::Workplace place("animation_plan");
    const auto plan = [&](const std::string& tracks) {
        place.write("room.toml", animated_room + "[animation]\nframes = 6\n" + tracks);
        const auto path = place.path / "room.toml";
        return cli::plan_animation(cli::read_frames(path, {}, cli::read_scene_file(path)));
    };
    const auto lamp_alone = plan(lamp);
    REQUIRE(lamp_alone.segments.size() == 1);
    CHECK(lamp_alone.segments[0].superposed);
    CHECK_FALSE(lamp_alone.segments[0].camera_moves);
    CHECK(lamp_alone.changed[3] == std::vector<std::string>{"emission of material \"lamp\""});
    // Two different frames cost less than two groups and a mesh.
    CHECK_FALSE(plan(track("material.lamp.emission",
                           "frames = [0, 3]\nvalues = [1, 2]\ninterpolation = \"step\""))
                    .segments[0]
                    .superposed);
    const auto camera = plan(
        track("camera.main.eye", "frames = [0, 5]\nvalues = [[1.9, 0.1, 1.2], [1.5, 0.1, 1]]"));
    REQUIRE(camera.segments.size() == 1);
    CHECK(camera.segments[0].camera_moves);
    CHECK(camera.changed[1] == std::vector<std::string>{"camera \"main\""});
    for (const auto& key : {"medium.haze.extinction", "solve.error"})
        CHECK(plan(track(key, "frames = [0, 5]\nvalues = [0.2, 0.5]")).segments.size() == 6);
    // The fog thickens in the middle: the same before, the same after.
    CHECK(plan(lamp + track("medium.haze.albedo",
                            "frames = [0, 3]\nvalues = [0.8, 0.2]\ninterpolation = \"step\""))
              .segments.size() == 2);
}

TEST_CASE("Frames that change in emission are sums, and equal full solves within the goal",
          "[animate][long]") {
    const test::Workplace place("animate");
    place.write("room.toml", animated_room + "[animation]\nframes = 6\nfps = 2\n" + lamp);
    const auto report = Json::parse(place.good("animate room.toml -o film --json"));
    CHECK(done(place, "film") ==
          "superposed superposed superposed superposed superposed superposed");
    CHECK(report.at("units").at(0).at("groups").size() == 2);
    CHECK(report.at("frames").at(2).at("changed").at(0) == "emission of material \"lamp\"");
    const auto series = Json::parse(place.read("film/solutions.vtkhdf.series"));
    CHECK(series.at("file-series-version") == "1.0");
    REQUIRE(series.at("files").size() == 6);
    CHECK(series.at("files").at(3).at("name") == "solutions/0003.vtkhdf");
    CHECK(series.at("files").at(3).at("time") == 1.5);

    place.good("run room.toml --quiet -o whole --set material.lamp.emission=4");
    const auto compared =
        Json::parse(place.good("compare film/frames/0003.exr whole/image.exr --json"));
    // Of 16 × 16 pixels that few rays make, to the goal of 0.2; the lamp's light alone is 40 % of
    // what frame 0 has of it.
    CHECK(compared.at("rmse").get<double>() < 0.2);
    CHECK(std::abs(compared.at("bias").get<double>()) < 0.1);
    // A frame can be rendered again from its solution alone, with its own emission.
    place.good("render film/solutions/0003.vtkhdf --quiet -o again.exr");
    CHECK(place.read("again.exr") == place.read("film/frames/0003.exr"));
}

TEST_CASE("Objects that move keep the room's light, and equal full solves within the goal",
          "[animate][long]") {
    const test::Workplace place("animate_moves");
    std::string with_box = animated_room;
    const std::string surfaces = "surface = [ ";
    with_box.insert(with_box.find(surfaces) + surfaces.size(),
                    "{ name = \"box\", material = \"grey\", translate = [0, 0, 0], "
                    "box = { min = [0.5, 0.4, 0.3], max = [0.9, 0.8, 0.7] } },\n            ");
    const std::string moves =
        track("surface.box.translate", "frames = [0, 3]\nvalues = [[0, 0, 0], [0.6, 0.5, 0.4]]");
    place.write("room.toml", with_box + "[animation]\nframes = 4\n" + moves);
    const auto report = Json::parse(place.good("animate room.toml -o film --json"));
    CHECK(done(place, "film") == "moved moved moved moved");
    CHECK(report.at("units").at(0).at("moving").at(0) == "box.bottom");
    CHECK(report.at("frames").at(0).at("rays_share") == 0.0);
    const double share = report.at("frames").at(3).at("rays_share").get<double>();
    CHECK(share > 0.0);
    CHECK(share < 0.5);  // a box of 0.4 m in a room of 2 m

    place.good("run room.toml --quiet -o whole --set 'surface.box.translate=[0.6,0.5,0.4]'");
    const auto compared =
        Json::parse(place.good("compare film/frames/0003.exr whole/image.exr --json"));
    // As sums: 16 x 16 pixels that few rays make, on another mesh, to the goal of 0.2.
    CHECK(compared.at("rmse").get<double>() < 0.2);
    CHECK(std::abs(compared.at("bias").get<double>()) < 0.1);
    // A part is the same, and a solution alone gives the picture again.
    place.good("animate room.toml -o part --quiet --frames 3");
    CHECK(place.read("part/frames/0003.exr") == place.read("film/frames/0003.exr"));
    place.good("render film/solutions/0003.vtkhdf --quiet -o again.exr");
    CHECK(place.read("again.exr") == place.read("film/frames/0003.exr"));
    for (const std::string method :
         {"projected_zones", "last_scatter", "two_pass", "path_traced"}) {
        const auto refused =
            place.run("render film/solutions/0003.vtkhdf --quiet -o no.exr --method " + method);
        CHECK(refused.code != 0);
        CHECK(refused.err.find("moves through the mesh") != std::string::npos);
    }
}

TEST_CASE("What cannot be a body is solved anew in every frame, and says why", "[animate][long]") {
    const test::Workplace place("animate_no_body");
    const auto reason = [&](const std::string& tracks, const std::string& more) {
        place.write("room.toml", animated_room + "[animation]\nframes = 2\n" + tracks);
        const auto report =
            Json::parse(place.good("animate room.toml -o film --json --frames 1" + more));
        CHECK(done(place, "film") == "solved");
        const Json warnings = report.at("frames").at(0).at("warnings");
        return warnings.empty() ? "" : warnings.back().get<std::string>();
    };
    const std::string lamp_moves =
        track("surface.lamp.translate", "frames = [0, 1]\nvalues = [[0, 0, -0.1], [0, 0, -0.2]]");
    CHECK(reason(lamp_moves, "") == "what moves is solved anew in every frame, since it emits.");
    CHECK(reason(lamp_moves, " --set solve.row_detail=4").find("(row_detail)") !=
          std::string::npos);
    CHECK(reason(lamp_moves, " --set render.method=two_pass") ==
          "what moves is solved anew in every frame, since it is drawn by \"two_pass\".");
}

TEST_CASE("Frames whose lights move keep exchange areas, and are whole solves to the bit",
          "[animate][long]") {
    const test::Workplace place("animate_lights");
    const std::string sun = track("light.sun.sun.direction",
                                  "frames = [0, 2]\nvalues = [[1, 0.2, -0.5], [1, -0.2, -0.3]]");
    const std::string denser =
        track("medium.haze.extinction", "frames = [2, 3]\nvalues = [0.5, 1]");
    place.write("room.toml", animated_room + "[animation]\nframes = 4\n" + sun + denser);
    const auto report = Json::parse(place.good("animate room.toml -o film --json"));
    CHECK(done(place, "film") == "solved solved solved solved");
    std::vector<bool> kept;
    for (const auto& frame : report.at("frames")) kept.push_back(frame.at("rows_kept"));
    CHECK(kept == std::vector{false, true, true, false});
    place.good("animate room.toml -o part --quiet --frames 2");
    CHECK(place.read("part/frames/0002.exr") == place.read("film/frames/0002.exr"));
}

TEST_CASE("Frames are kept, made in parts, and made anew for another scene", "[animate][long]") {
    const test::Workplace place("animate_parts");
    const std::string camera =
        track("camera.main.eye", "frames = [0, 3]\nvalues = [[1.9, 0.1, 1.2], [1.5, 0.1, 1]]");
    place.write("room.toml", animated_room + "[animation]\nframes = 4\n" + camera);
    place.good("animate room.toml -o film --quiet --frames 0:1");
    CHECK(done(place, "film") == "solved kept");
    const auto first = place.read("film/frames/0000.png");
    CHECK(place.good("animate room.toml -o film --resume").find("2 of them from before") !=
          std::string::npos);
    CHECK(done(place, "film") == "solved kept solved kept");
    CHECK(place.read("film/frames/0000.png") == first);
    // All at once gives the same.
    place.good("animate room.toml -o whole --quiet");
    CHECK(place.read("whole/frames/0003.png") == place.read("film/frames/0003.png"));
    // Other settings: nothing of before stays.
    place.good("animate room.toml -o film --quiet --resume --frames 3 --set render.samples=2");
    CHECK_FALSE(place.has("film/frames/0000.png"));
    CHECK(place.has("film/frames/0003.exr"));

    const auto wrong = place.run("animate room.toml -o film --frames 2:4");
    CHECK(wrong.code == 1);
    test::check_one_message(wrong);
    place.write("still.toml", animated_room);
    const auto still = place.run("animate still.toml -o film");
    CHECK(still.code == 1);
    CHECK(still.err.find("has no [animation]") != std::string::npos);
}

TEST_CASE("A mesh that fails names its frame; other commands take the section", "[animate]") {
    const test::Workplace place("animate_fails");
    place.write("room.toml",
                animated_room + "[animation]\nframes = 2\n" +
                    track("medium.haze.at", "frames = [0, 1]\nvalues = [[1, 1, 1], [9, 9, 9]]"));
    const auto failed = place.run("animate room.toml -o film --quiet");
    CHECK(failed.code == 1);
    CHECK(failed.err.find("in frame 1 of the animation: ") != std::string::npos);
    CHECK(place.has("film/frames/0000.png"));
    CHECK_FALSE(place.has("film/frames/0001.png"));
    place.good("check room.toml --quiet");
}

TEST_CASE("Ctrl-C leaves whole frames only", "[animate]") {
    const test::Workplace place("animate_stops");
    place.write("room.toml",
                animated_room + "[animation]\nframes = 500\n" +
                    track("light.sun.sun.direction",
                          "frames = [0, 499]\nvalues = [[1, 0.2, -0.5], [1, -0.2, -0.5]]"));
    test::Running job(place.path, {"animate", "room.toml", "-o", "film", "--quiet"});
    for (int k = 0; k < 3000 && !place.has("film/report.json"); ++k) ::usleep(10000);
    REQUIRE(place.has("film/report.json"));
    job.signal(SIGINT);
    CHECK(test::exit_code(job.wait()) == 0);
    const Json frames = Json::parse(place.read("film/report.json")).at("frames");
    CHECK(frames.size() < 500);
    std::size_t pictures = 0;
    for (const auto& entry : std::filesystem::directory_iterator(place.path / "film/frames"))
        pictures += entry.path().extension() == ".exr";
    CHECK(pictures == frames.size());
}
