// report.html: its structure, its figures, and what it says in words.
#include "view/report_page.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "radiosity/adaptive.h"
#include "radiosity/report_json.h"
#include "support/catch.h"
#include "support/occurrences.h"
#include "support/path_scenes.h"
#include "support/rooms.h"
#include "support/well_formed.h"
#include "view/markup.h"
#include "view/report_scene.h"

using namespace tyndall;

namespace {

constexpr const char* nasty = "<script>alert('x')</script> & \"co\"";

radiosity::Solution solved(radiosity::Scene scene) {
    return radiosity::solve_adaptively(
        std::make_shared<const radiosity::Enclosure>(radiosity::make_enclosure(scene)),
        {.error = 0.2,
         .start = radiosity::Start::base,
         .max_elements = 1500,
         .rays = 16,
         .gather_rays = 16});
}

// A room in two bands whose names are markup.
const radiosity::Solution& nasty_solution() {
    static const radiosity::Solution solution = [] {
        radiosity::Scene scene = test::slit_room();
        scene.bands = 2;
        scene.materials[0].reflectance = {0.6, 0.3};
        scene.materials[1].reflectance = {0.0, 0.0};
        scene.materials[1].emission = radiosity::Spectrum{10.0, 5.0};
        scene.surfaces[0].name = nasty;
        scene.media[0].name = "a<b";
        scene.media[0].extinction = {0.2, 0.4};
        scene.media[0].albedo = {0.9, 0.5};
        return solved(scene);
    }();
    return solution;
}

std::string cell(const std::string& name, const std::string& value) {
    return "<th scope=\"row\">" + view::escaped(name) + "</th><td>" + view::escaped(value);
}

std::string number(const std::string& name, const std::string& value) {
    return "<th scope=\"row\">" + view::escaped(name) + "</th><td class=\"number\">" +
           view::escaped(value) + "</td>";
}

}  // namespace

TEST_CASE("A report is a page without a script, and names are text in it", "[view]") {
    view::ReportPageOptions options;
    options.title = nasty;
    options.materials[nasty + std::string("+")] = "<b>";
    options.cameras = {test::camera_at({0.4, 0.3, 1.2}, {3.0, 1.6, 1.4}, 1.3, 32, 24)};
    options.cameras[0].name = "<camera>";
    options.view_camera = "<camera>";
    options.picture = "\x89PNG\r\n";
    options.picture_alternative = "what \"it\" shows";
    options.scene_text = "title = '<&>'\n";
    options.view_link = "view.html";
    options.notes = {"a <note>"};
    const std::string page = view::report_page(nasty_solution(), options);
    CHECK(view::report_page(nasty_solution(), options) == page);
    CHECK(test::occurrences(page, "<script") == 0);
    CHECK(test::occurrences(page, "{{") == 0);
    CHECK(test::occurrences(page, " src=") == 1);  // the picture, which is in the page
    CHECK(test::occurrences(page, "http") == 0);   // nothing is fetched
    CHECK(test::occurrences(page, "<h1>" + view::escaped(nasty) + "</h1>") == 1);
    // Style sheets are no markup.
    std::string body = page.substr(page.find("<body"));
    body.resize(body.rfind("</html>"));
    CHECK(test::well_formed(body));
    CHECK_THAT(page,
               Contains("data:image/png;base64,iVBORw0K") &&
                   Contains("alt=\"what &quot;it&quot; shows\"") && Contains("a &lt;note&gt;") &&
                   Contains("<td>&lt;b&gt;") && Contains("title = &#39;&lt;&amp;&gt;&#39;\n") &&
                   Contains(cell("<camera>", "perspective")) && Contains("<a href=\"view.html\">"));
    // Every chart has a title and a description, every table a caption.
    CHECK(test::occurrences(page, "<svg") >= 6);
    CHECK(test::occurrences(page, "<svg") ==
          test::occurrences(page, "<title>") - 1 - test::occurrences(page, "><title>"));
    CHECK(test::occurrences(page, "<svg") == test::occurrences(page, "<desc>"));
    CHECK(test::occurrences(page, "<table>") == test::occurrences(page, "<caption>"));
    for (const char* id : {"warnings", "solution", "scene", "power", "passes", "mesh", "again"})
        CHECK(test::occurrences(page, "id=\"" + std::string(id) + "\"") == 1);
    CHECK(test::occurrences(page, "href=\"#") >= 7);
}

TEST_CASE("A report's figures are those of report.json", "[view]") {
    const auto& s = nasty_solution();
    auto json =
        nlohmann::ordered_json::parse(radiosity::report_to_json(s.report, radiosity::Costs::kept));
    json["scene"] = "a b.toml";
    json["command"] = "tyndall run 'a b.toml' -o out";
    json["seed"] = 7;
    json["threads"] = 2;
    json["wall_seconds"] = 12.5;
    json["cpu_seconds"] = 20.0;
    json["peak_memory_bytes"] = 123e6;
    view::ReportPageOptions options;
    options.report = json.dump();
    options.goal = 0.05;
    const std::string page = view::report_page(s, options);
    CHECK_THAT(
        page,
        Contains(cell("patches", std::to_string(s.report.patches))) &&
            Contains(cell("zones", std::to_string(s.report.zones))) &&
            Contains(cell("estimated error", view::percent(s.report.estimated_error))) &&
            Contains(cell("goal of the error", "5 %")) &&
            Contains(cell("closure error", view::figure(s.report.closure_error))) &&
            Contains(cell("energy balance, missed", view::percent(s.report.energy_balance))) &&
            Contains(cell("seed", "7")) && Contains(cell("threads", "2")) &&
            Contains(cell("time", "12.5 s, 20 s of CPU")) &&
            Contains(cell("most memory", "123 MB")) &&
            Contains("tyndall run &#39;a b.toml&#39; -o out"));
    double sum = 0.0;
    for (const auto& [name, power] : s.report.net_power) {
        CAPTURE(name);
        const double sign = name == "outside" ? -1.0 : 1.0;
        CHECK_THAT(page, Contains(number(name, view::figure(sign * (power[0] + power[1])))));
        sum += sign * (power[0] + power[1]);
    }
    CHECK_THAT(page, Contains("Net power in each band"));
    for (const auto& pass : s.report.passes)
        CHECK_THAT(page, Contains("<th scope=\"row\">" + pass.stage + "</th><td class=\"number\">" +
                                  std::to_string(pass.patches)));
    CHECK_THAT(page, Contains(view::figure(sum)));
    CHECK_THAT(page, Contains("above the goal of 5 %") || Contains("error goal of"));
}

TEST_CASE("A report says what is not known, and prints no NaN", "[view]") {
    auto s = nasty_solution();
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    s.report.reciprocity_error = unknown;
    s.report.energy_balance = unknown;
    s.report.net_power.begin()->second[0] = unknown;
    s.report.passes[0].estimated_error = unknown;
    s.report.temperature["a<b"] = {300.0, unknown, 310.5};
    s.zone_error.assign(s.zone_error.size(), std::numeric_limits<float>::quiet_NaN());
    s.report.stopped = true;
    const std::string page = view::report_page(s, {});
    const std::string body = page.substr(page.find("<body"));
    CHECK(test::occurrences(body, "nan") == test::occurrences(body, "nano"));
    CHECK(test::occurrences(body, "inf") == 0);
    CHECK_THAT(page, Contains(cell("reciprocity error", "not known")) &&
                         Contains("<th scope=\"row\">a&lt;b</th><td class=\"number\">300</td>"
                                  "<td class=\"number\">not known</td>") &&
                         Contains("stopped before its end"));
    // Without passes, camera, history: sections are left out, not empty.
    s.report = {};
    const std::string bare = view::report_page(s, {});
    CHECK(test::occurrences(bare, "id=\"passes\"") == 0);
    CHECK(test::occurrences(bare, "id=\"solver\"") == 0);
    CHECK_THAT(bare,
               Contains("There are no warnings") &&
                   Contains(cell("patches", std::to_string(nasty_solution().report.patches))) &&
                   Contains(cell("estimated error", "not known")) &&
                   Contains(cell("solver", "not known")));
}

TEST_CASE("The mean chord of a room is 4 V / S, and a partition's two sides count", "[view]") {
    radiosity::Scene scene;
    scene.materials = {test::material(0.5, 1.0)};
    test::add_surfaces(scene, "room", mesh::room({0, 0, 0}, {3, 2, 2}), 0);
    scene.media = {test::medium(0.3, 0.5)};
    const auto room = radiosity::make_enclosure(scene);
    CHECK(view::mean_chords(room).at(0) == Approx(4.0 * 12.0 / 32.0));
    test::add_surfaces(scene, "wall", mesh::rectangle({1, 0.5, 0.5}, {0, 1, 0}, {0, 0, 1}), 0);
    CHECK(view::mean_chords(radiosity::make_enclosure(scene)).at(0) == Approx(48.0 / 34.0));
}

TEST_CASE("What goes to outside is told in words", "[view]") {
    radiosity::Scene scene = test::slit_room();
    const auto ceiling = test::surface_named(scene, "room.ceiling");
    scene.surfaces[ceiling].material.reset();
    for (auto& polygon : scene.surfaces[ceiling].polygons)
        polygon.opacity = mesh::Opacity::interface;
    scene.media[0].at = mesh::Point(0.5, 0.5, 0.5);
    const auto open = solved(scene);
    CHECK_THAT(view::report_page(open, {}),
               Contains("The scene is open: " +
                        view::figure(open.report.net_power.at("outside")[0]) + " W leave"));
    CHECK(view::report_page(nasty_solution(), {}).find("The scene is open") == std::string::npos);
}
