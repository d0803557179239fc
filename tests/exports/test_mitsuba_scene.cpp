// Mitsuba scenes: well-formed, everything that is named is there, numbers in their places. That
// Mitsuba makes the same picture of them is tested by mitsuba_pictures.py.
#include "exports/mitsuba_scene.h"

#include <regex>
#include <set>

#include "mesh/input_error.h"
#include "rich_room.h"
#include "support/catch.h"

using namespace tyndall;

namespace {

// Checks that elements nest; returns how often each name is opened.
std::map<std::string, int> check_nesting(const std::string& text) {
    // No two hyphens in a comment, but for its end.
    const std::string xml = std::regex_replace(text, std::regex("<!--([^-]|-[^-])*-->"), "");
    CHECK(xml.find("<!--") == std::string::npos);
    std::map<std::string, int> counts;
    std::vector<std::string> open;
    const std::regex tag(
        R"(<(/?)([A-Za-z]+)((?:\s+[a-z_]+="[^"<>&]*(?:&[a-z]+;[^"<>&]*)*")*)\s*(/?)>)");
    std::size_t at = 0;
    for (auto it = std::sregex_iterator(xml.begin(), xml.end(), tag); it != std::sregex_iterator();
         ++it) {
        const std::string between = xml.substr(at, std::size_t(it->position()) - at);
        // Beside elements there is nothing but blanks and the first line.
        CHECK(std::regex_match(between, std::regex(R"(\s*(<\?xml[^?]*\?>\s*)?)")));
        at = std::size_t(it->position() + it->length());
        const std::string name = (*it)[2];
        if ((*it)[1].length() > 0) {
            REQUIRE(!open.empty());
            CHECK(open.back() == name);
            open.pop_back();
        } else {
            ++counts[name];
            if ((*it)[4].length() == 0) open.push_back(name);
        }
    }
    CHECK(open.empty());
    return counts;
}

std::vector<std::string> all(const std::string& text, const std::string& pattern) {
    std::vector<std::string> found;
    const std::regex regex(pattern);
    for (auto it = std::sregex_iterator(text.begin(), text.end(), regex);
         it != std::sregex_iterator(); ++it)
        found.push_back((*it)[1]);
    return found;
}

}  // namespace

TEST_CASE("A scene for Mitsuba is whole", "[export]") {
    const auto enclosure = test::enclosed(test::rich_room());
    auto side = test::rich_camera();
    side.name = "side";
    side.projection = radiosity::PictureProjection::orthographic;
    side.fov_x = {};
    side.extent_x = 2.0;
    const std::vector cameras{test::rich_camera(), side};
    const auto files = exports::mitsuba_scene(*enclosure, cameras,
                                              {.title = "Rich <room> -- & more", .stem = "rich"});
    const auto counts = check_nesting(files.main);
    CHECK(counts.at("sensor") == 2);
    CHECK(counts.at("medium") == 2);
    std::set<std::string> parts, ids;
    for (const auto& file : files.beside) {
        CHECK(parts.insert(file.name).second);
        CHECK(file.bytes.starts_with("ply\n"));
    }
    const auto named = all(files.main, R"re(name="filename" value="([^"]*)")re");
    CHECK(std::set(named.begin(), named.end()) == parts);
    for (const auto& id : all(files.main, R"re( id="([^"]*)" type)re")) ids.insert(id);
    for (const auto& reference : all(files.main, R"re(<ref name="[a-z]+" id="([^"]*)")re"))
        CHECK(ids.contains(reference));
    CHECK(all(files.main, R"re(name="g" value="([^"]*)")re") == std::vector<std::string>{"0.7"});
    // Point, spot, directional, the sun's disc, the sky, and two sides of the screen.
    CHECK(counts.at("emitter") == 7);
    CHECK(all(files.main, R"re(<emitter type="(constant|point|spot|directional)")re").size() == 4);
    CHECK(all(files.main, R"re(beam_width" value="([^"]*)")re")[0].starts_with("14.3239"));
    CHECK(all(files.main, R"re(cutoff_angle" value="([^"]*)")re")[0].starts_with("20.0535"));
    CHECK(all(files.main, R"re(alpha" value="([^"]*)")re") == std::vector<std::string>{"0.09"});
    CHECK(files.notes.size() == 2);  // the spot's edge, gloss
}

TEST_CASE("Bands whose extinctions differ are followed with weights for all of them", "[export]") {
    auto scene = test::slit_room();
    scene.bands = 3;
    for (auto& m : scene.materials) {
        m.reflectance = {0.1, 0.2, 0.3};
        if (!m.emission.empty()) m.emission = {1, 2, 3};
    }
    scene.media[0].extinction = {0.5, 1.0, 4.0};
    scene.media[0].albedo = {0.5, 0.5, 0.5};
    const auto camera = test::rich_camera();
    const auto files = exports::mitsuba_scene(*test::enclosed(scene), {&camera, 1});
    CHECK_THAT(files.main, Contains("type=\"volpathmis\""));
    CHECK_THAT(files.main, Contains("name=\"scale\" value=\"4\""));
    CHECK_THAT(files.main, Contains("name=\"sigma_t\" value=\"0.125, 0.25, 1\""));
    CHECK_THAT(files.main, Contains("name=\"radiance\" value=\"1, 2, 3\""));
    CHECK_THAT(files.main, Contains("value=\"rgb\""));
}

TEST_CASE("What Mitsuba has no word for is said", "[export]") {
    auto scene = test::slit_room();
    auto camera = test::rich_camera();
    const auto make = [&] { return exports::mitsuba_scene(*test::enclosed(scene), {&camera, 1}); };
    SECTION("a medium that emits") {
        scene.media[0].emission = {1.0};
        CHECK_THROWS_WITH(make(), Contains("\"haze\" emits") && Contains("--format pbrt"));
    }
    SECTION("a panorama") {
        camera.projection = radiosity::PictureProjection::panorama;
        camera.fov_x = {};
        camera.width = 64;
        camera.height = 32;
        CHECK_THROWS_WITH(make(), Contains("\"main\" is a panorama"));
    }
    SECTION("no camera") {
        CHECK_THROWS_WITH(exports::mitsuba_scene(*test::enclosed(scene), {}),
                          Contains("no camera"));
    }
}
