// tyndall view, and the page that a run writes.
#include <nlohmann/json.hpp>

#include "support/catch.h"
#include "support/foggy_box.h"
#include "support/program.h"
#include "view/markup.h"

using namespace tyndall;

namespace {

// What the page says of itself.
nlohmann::json meta_of(const std::string& page) {
    const std::string begin = "id=\"meta\">";
    const auto at = page.find(begin) + begin.size();
    return nlohmann::json::parse(page.substr(at, page.find("</script>", at) - at));
}

std::string view_complaint(const test::Workplace& place, const std::string& arguments) {
    const auto outcome = place.run(arguments);
    CHECK(outcome.code == 1);
    test::check_one_message(outcome);
    return outcome.err;
}

}  // namespace

TEST_CASE("A run writes a page, and view makes it again from the solution alone", "[view]") {
    const test::Workplace place("view");
    place.write("box.toml", test::foggy_box);
    CHECK_THAT(place.good("run box.toml -o out"), Contains("out/view.html"));
    const auto page = place.read("out/view.html");
    const auto meta = meta_of(page);
    CHECK(meta["title"] == "Foggy box");
    CHECK(meta["cameras"].size() == 2);
    CHECK(meta["cameras"][1]["name"] == "side");
    CHECK(meta["report"]["wall_seconds"].get<double>() > 0.0);
    CHECK(meta["report"] == nlohmann::json::parse(place.read("out/report.json")));

    CHECK(meta["report"]["command"] == "tyndall run box.toml -o out");
    CHECK(meta["meshes"].back()["zones"] == meta["report"]["zones"]);
    const auto report = place.read("out/report.html");
    place.good("view out --threads 1 --quiet");
    CHECK(place.read("out/view.html") == page);
    CHECK(place.read("out/report.html") == report);
    // A page of another name stands for itself.
    place.good("view out -o again.html --quiet");
    CHECK(meta_of(place.read("again.html"))["meshes"] == meta["meshes"]);
    CHECK_THAT(page, Contains("href=\"report.html\""));
    CHECK_THAT(place.read("again.html"), !Contains("href=\"report.html\""));
    CHECK(!place.has("report.html"));
    // The report of another run is not the solution's.
    place.write("out/report.json", R"({"patches": 1, "zones": 1, "estimated_error": 0.5})");
    const auto made = nlohmann::json::parse(place.good("view out/ --json --set render.exposure=1"));
    CHECK(made["file"] == "out/view.html");
    CHECK(made["bytes"] == place.read("out/view.html").size());
    const auto brighter = meta_of(place.read("out/view.html"));
    CHECK(brighter["report"]["patches"] == meta["report"]["patches"]);
    CHECK(brighter["cameras"][0]["white"].get<double>() ==
          Approx(0.5 * meta["cameras"][0]["white"].get<double>()));

    place.good("run box.toml -o plain --no-view --quiet");
    CHECK(!place.has("plain/view.html"));
    CHECK_THAT(place.read("plain/report.html"), !Contains("href=\"view.html\""));
    CHECK(place.read("plain/solution.vtkhdf") == place.read("out/solution.vtkhdf"));
    CHECK_THAT(place.good("solve box.toml -o out"),
               Contains("view.html in 'out' is of an earlier run"));
}

TEST_CASE("view says what is wrong", "[view]") {
    const test::Workplace place("view_wrong");
    CHECK_THAT(view_complaint(place, "view nowhere"), Contains("nowhere"));
    place.write("not.vtkhdf", "no solution");
    CHECK_THAT(view_complaint(place, "view not.vtkhdf"), Contains("not.vtkhdf"));
    CHECK_THAT(view_complaint(place, "view not.vtkhdf -o picture.png"), Contains(".html"));
    CHECK(!place.has("view.html"));
}

TEST_CASE("Every run and solve writes a report as a page", "[view]") {
    const test::Workplace place("report_page");
    place.write("box.toml", test::foggy_box);
    const std::string coarse = " --quiet --set solve.refinement=none --set solve.rays=4";
    place.good("run box.toml -o out --no-view --set 'material.grey.reflectance=0.25'" + coarse);
    const auto page = place.read("out/report.html");
    CHECK_THAT(page, Contains("<h1>Foggy box</h1>") && Contains("data:image/png;base64,") &&
                         Contains("seen by camera main") &&
                         Contains("<th scope=\"row\">room.floor+</th><td>grey</td>"
                                  "<td class=\"number\">4</td><td class=\"number\">0.25</td>") &&
                         Contains("--set material.grey.reflectance=0.25") &&
                         Contains("reflectance = 0.25") && Contains("<td>box.toml</td>"));

    // solve has no picture of its own, and says that the one there is another run's.
    place.good("solve box.toml -o out" + coarse);
    const auto solved = place.read("out/report.html");
    CHECK_THAT(solved, !Contains("data:image/png") &&
                           Contains("image.exr in &#39;out&#39; is of an earlier run"));
    // Nor does a page made from the solution take it; a camera that has moved is told of.
    place.good("view out --quiet --set camera.main.eye=[1,1,1]");
    CHECK_THAT(place.read("out/report.html"),
               !Contains("data:image/png") && Contains("Camera &quot;main&quot; has been changed"));

    // A limit of time, and no report.
    place.good("solve box.toml -o short --set solve.max_time=1e-6" + coarse);
    CHECK_THAT(place.read("short/report.html"),
               Contains("<strong>Warning:</strong>") && Contains("max_time"));
    place.good("run box.toml -o none --no-report --no-view" + coarse);
    CHECK(!place.has("none/report.html"));
}

TEST_CASE("A report of heat has fluxes and temperatures, of walls with a given flux too",
          "[view]") {
    const test::Workplace place("report_heat");
    place.write("hot.toml", R"(format = 1
[[material]]
name = "oven"
reflectance = 0.2
temperature = 900
[[material]]
name = "insulated"
reflectance = 0.3
flux = 0.0
[[surface]]
name = "room"
material = "oven"
room = { min = [0,0,0], max = [1,1,1] }
[[surface]]
name = "shield"
material = "insulated"
rectangle = { corner = [0.5,0.2,0.2], u = [0,0.6,0], v = [0,0,0.6] }
[solve]
rays = 16
gather_rays = 16
refinement = "none"
element_size = 0.8
)");
    place.good("solve hot.toml -o out --quiet");
    const auto page = place.read("out/report.html");
    CHECK_THAT(page, Contains("<h1>hot</h1>") && Contains("Temperatures [K]") &&
                         Contains("0 W/m² net") && Contains("W/(m² sr)") && !Contains("Cameras"));
    const auto found = nlohmann::json::parse(place.read("out/report.json"))["temperature"];
    CHECK_THAT(page, Contains("<th scope=\"row\">shield+</th><td class=\"number\">" +
                              view::figure(found["shield+"]["mean"]) + "</td>") &&
                         Contains("<td class=\"number\">9474 W/(m² sr)"));
    CHECK(page.find("nan") == std::string::npos);
}
