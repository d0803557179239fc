// tyndall view, and the page that a run writes.
#include <nlohmann/json.hpp>

#include "support/catch.h"
#include "support/foggy_box.h"
#include "support/program.h"

using namespace tyndall;

namespace {

// What the page says of itself.
nlohmann::json meta_of(const std::string& page) {
    const std::string begin = "id=\"meta\">";
    const auto at = page.find(begin) + begin.size();
    return nlohmann::json::parse(page.substr(at, page.find("</script>", at) - at));
}

std::string complaint(const test::Workplace& place, const std::string& arguments) {
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

    place.good("view out -o again.html --threads 1 --quiet");
    CHECK(place.read("again.html") == page);
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
    CHECK(place.read("plain/solution.vtkhdf") == place.read("out/solution.vtkhdf"));
    CHECK_THAT(place.good("solve box.toml -o out"),
               Contains("view.html in 'out' is of an earlier run"));
}

TEST_CASE("view says what is wrong", "[view]") {
    const test::Workplace place("view_wrong");
    CHECK_THAT(complaint(place, "view nowhere"), Contains("nowhere"));
    place.write("not.vtkhdf", "no solution");
    CHECK_THAT(complaint(place, "view not.vtkhdf"), Contains("not.vtkhdf"));
    CHECK_THAT(complaint(place, "view not.vtkhdf -o picture.png"), Contains(".html"));
    CHECK(!place.has("view.html"));
}
