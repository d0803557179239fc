// Pictures while a run goes on.
#include <numbers>

#include "radiosity/first_look.h"
#include "render/image_files.h"
#include "support/catch.h"
#include "support/program.h"
#include "support/rooms.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

// A small foggy room with a lamp and a camera, solved to little.
const char* const room = R"(
format = 1
material = [ { name = "grey", reflectance = 0.5 },
             { name = "lamp", reflectance = 0.0, emission = 10.0 } ]
surface = [ { name = "room", material = "grey", room = { min = [0, 0, 0], max = [2, 2, 2] } },
            { name = "shelf", material = "grey", rectangle = { corner = [0, 0, 1], u = [1, 0, 0], v = [0, 2, 0] } },
            { name = "lamp", material = "lamp", rectangle = { corner = [0.5, 0.5, 2], u = [0, 1, 0], v = [1, 0, 0] } } ]
medium = [ { name = "haze", extinction = 0.5, albedo = 0.8 } ]
camera = [ { name = "main", eye = [1.9, 0.1, 1.2], target = [0, 2, 0.8], fov_y = 60, width = 24, height = 24 } ]
solve = { error = 0.3, rays = 16, gather_rays = 16, element_size = 1.0, max_elements = 1500 }
)";
const std::string job = "run room.toml --quiet --no-view ";

std::size_t frames_in(const test::Workplace& place, const std::string& folder) {
    std::size_t count = 0;
    while (place.has(folder + "/frames/000" + std::to_string(count + 1) + ".png")) ++count;
    return count;
}

}  // namespace

TEST_CASE("A first look is direct light and the ambient estimate, without the medium",
          "[preview]") {
    Scene scene;
    scene.materials = {test::material(0.6), test::material(0.6, 2.0)};
    test::add_surfaces(scene, "room", mesh::room({0, 0, 0}, {1, 1, 1}), 0);
    scene.surfaces[test::surface_named(scene, "room.floor")].material = 1;
    scene.media = {test::medium(3.0, 0.5)};
    const auto look = first_look(make_enclosure(scene), {});
    for (const auto medium : look.enclosure->region_medium) CHECK(medium == none);
    // All that the floor emits, 2 a unit area, arrives: (36) is 0.6 · 2 / 6 / 0.4. Means of leaves
    // by three corners and the centroid are known to some percent beside the lit edges.
    const auto& forest = look.forest;
    for (std::uint32_t p = 0; p < forest.patch_count(); ++p)
        if (forest.is_leaf(PatchId(p)) &&
            side_of(*look.enclosure, forest, PatchId(p)) != radiosity::none)
            CHECK(look.indirect.at(PatchId(p), 0).constant == Approx(0.5).epsilon(0.03));
}

TEST_CASE("A preview shows surfaces first and changes nothing", "[preview]") {
    const test::Workplace place("preview");
    place.write("room.toml", room);
    place.good(job + "-o plain");
    place.good(job + "-o seen --frames");
    CHECK_FALSE(place.has("plain/preview.png"));
    CHECK(place.read("plain/image.exr") == place.read("seen/image.exr"));
    // Surfaces, the coarse solution, direct light, the last one.
    const std::size_t frames = frames_in(place, "seen");
    CHECK(frames >= 4);
    const auto last = place.read("seen/frames/000" + std::to_string(frames) + ".png");
    CHECK(last == place.read("seen/preview.png"));
    CHECK(last == place.read("seen/image.png"));
    CHECK(place.read("seen/frames/0001.png") != place.read("seen/frames/0002.png"));
}

TEST_CASE("Previews keep their distance in time, and frames of an earlier run go", "[preview]") {
    const test::Workplace place("preview_every");
    place.write("room.toml", room);
    place.good(job + "-o seen --frames");
    place.good(job + "-o seen --frames --preview-every 1000");
    CHECK(frames_in(place, "seen") == 2);  // surfaces at once, and the last one
    place.good(job + "-o blind --preview --set solve.camera=");
    CHECK(place.has("blind/preview.png"));
    const auto wrong = place.run(job + "-o seen --preview-every -1");
    CHECK(wrong.code == 2);
    test::check_one_message({wrong.code, "", wrong.err.substr(0, wrong.err.find('\n') + 1)});
}
