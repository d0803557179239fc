// Charts of reports: axes, histograms, and SVG that reads well.
#include "view/charts.h"

#include <cmath>
#include <limits>

#include "support/catch.h"
#include "support/occurrences.h"
#include "support/well_formed.h"
#include "view/markup.h"
#include "view/plot_axis.h"
#include "view/shape_quality.h"

using namespace tyndall;
using namespace tyndall::view;

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE("Text and numbers show as what they are", "[view]") {
    CHECK(escaped("a<b> & \"c\" 'd'\x01\n") == "a&lt;b&gt; &amp; &quot;c&quot; &#39;d&#39; ");
    CHECK(multiline("a<\n\nb") == "a&lt;\n\nb");
    CHECK(figure(0.0) == "0");
    CHECK(figure(-12345.0) == "−12345");
    CHECK(figure(0.0123456) == "0.01235");
    CHECK(figure(unknown) == "not known");
    CHECK(percent(0.0123) == "1.23 %");
    CHECK(percent(unknown) == "not known");
    CHECK(seconds(0.0) == "not known");
    CHECK(seconds(6000.0) == "100.0 min");
    const auto table = table_markup({"a < b", {"name", "value"}, {{"<i>", "1"}}});
    CHECK(test::well_formed(table));
    CHECK_THAT(table, Contains("<caption>a &lt; b</caption>") && Contains("<th scope=\"col\"") &&
                          Contains("<th scope=\"row\">&lt;i&gt;</th>"));
    CHECK(table_markup({"empty", {"name"}, {}}).empty());
}

TEST_CASE("Curves have titles, and leave out what a logarithm cannot show", "[view]") {
    const ChartWords words{"Error & <cost>", "What it is", "elements", "error [%]"};
    const auto svg = curve_chart(
        words, {{"a<b", {{100, 0}, {1000, 5}, {10000, 1}, {unknown, 2}}}, {"other", {{200, 3}}}},
        AxisScale::logarithmic, {"goal", 2.0});
    CHECK(test::well_formed(svg));
    CHECK_THAT(svg, Contains("<title>Error &amp; &lt;cost&gt;</title><desc>What it is</desc>") &&
                        Contains("role=\"img\"") && Contains("a&lt;b") && Contains("goal"));
    CHECK(test::occurrences(svg, "<polyline class=\"curve style0\"") == 1);
    CHECK(test::occurrences(svg, "<circle class=\"mark style0\"") ==
          3);  // two points, and the legend's
    CHECK(test::occurrences(svg, "nan") == 0);
    CHECK(curve_chart(words, {{"one", {{1, 1}}}}, AxisScale::linear).empty());
    CHECK(curve_chart(words, {{"none", {{1, 0}, {2, unknown}}}}, AxisScale::linear).empty());
}

TEST_CASE("Bars reach to either side of zero as far as their values say", "[view]") {
    const auto svg = bar_chart({"Power", "Bars", "W", ""},
                               {{"lamp", 30.0}, {"wall & co", -15.0}, {"unknown", unknown}});
    CHECK(test::well_formed(svg));
    CHECK_THAT(svg,
               Contains("lamp: 30") && Contains("wall &amp; co: −15") && Contains("not known"));
    const auto width = [&](const std::string& kind) {
        const auto at = svg.find("width=", svg.find("bar " + kind));
        return std::stod(svg.substr(at + 7));
    };
    // Written to a hundredth of a pixel.
    CHECK(width("style0") == Approx(2.0 * width("style1")).margin(0.02));
    CHECK(test::occurrences(svg, "nan") == 0);
    CHECK(bar_chart({}, {}).empty());
}

TEST_CASE("Histograms count every number once", "[view]") {
    const auto h = log_histogram({"a", "b"}, {{0.0, 1e-3, 2e-3, 5.0, unknown}, {0.3, 0.3}});
    CHECK(h.zeros == std::vector<std::size_t>{1, 0});
    std::size_t a = 0, b = 0;
    for (std::size_t k = 0; k + 1 < h.edges.size(); ++k) a += h.counts[0][k], b += h.counts[1][k];
    CHECK(a == 3);
    CHECK(b == 2);
    CHECK(h.edges.size() <= 25);
    CHECK(h.edges.front() <= 1e-3 * (1 + 1e-9));
    CHECK(h.edges.back() >= 5.0);
    // Twenty decades fit, too.
    const auto wide = log_histogram({"a"}, {{1e-12, 1e12}});
    CHECK(wide.edges.size() <= 25);
    CHECK(wide.counts[0].front() + wide.counts[0].back() == 2);
    const auto levels = whole_histogram({"a"}, {{0, 0, 3, 1}});
    REQUIRE(levels.edges == std::vector<double>{0, 1, 2, 3, 4});
    CHECK(levels.counts[0] == std::vector<std::size_t>{2, 1, 0, 1});
    const auto shares = share_histogram({"a"}, {{0.0, 1.0, 0.52}});
    CHECK(shares.counts[0].front() == 1);
    CHECK(shares.counts[0].back() == 1);
    CHECK(shares.counts[0][10] == 1);
    const auto svg = histogram_chart({"Level", "", "level", "elements"}, levels);
    CHECK(test::well_formed(svg));
    CHECK(test::occurrences(svg, "<rect") == 3);
    CHECK(histogram_chart({}, whole_histogram({"a"}, {{}})).empty());
}

TEST_CASE("Ticks stand at decades, and at 2 and 5 where there are few", "[view]") {
    CHECK(log_ticks(90, 200000) == std::vector<double>{100, 1000, 10000, 100000});
    CHECK(log_ticks(1, 20) == std::vector<double>{1, 2, 5, 10, 20});
    CHECK(tick_text(0.01) == "0.01");
    CHECK(tick_text(2000) == "2000");
    CHECK(tick_text(2e5) == "2·10⁵");
    CHECK(tick_text(1e-12) == "10⁻¹²");
    CHECK(linear_ticks(52.5) == std::vector<double>{0, 10, 20, 30, 40, 50});
}

TEST_CASE("Shape quality is 1 for regular elements and falls to 0", "[view]") {
    using Triangle = std::array<mesh::Point, 3>;
    using Tet = std::array<mesh::Point, 4>;
    const double h = std::sqrt(3.0) / 2.0;
    CHECK(mean_ratio(Triangle{{{0, 0, 0}, {1, 0, 0}, {0.5, h, 0}}}) == Approx(1.0));
    CHECK(mean_ratio(Tet{{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}}) == Approx(1.0));
    // A right isosceles triangle: 4 √3 · ½ / 4 = √3/2.
    CHECK(mean_ratio(Triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}) == Approx(h));
    CHECK(mean_ratio(Triangle{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}}) == 0.0);
    CHECK(mean_ratio(Tet{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}}) == 0.0);
    // Inscribed and circumscribed circles of the right isosceles triangle: 2 (1 − √½) / √½.
    const double leg = std::sqrt(0.5);
    CHECK(radius_ratio(Triangle{{{0, 0, 0}, {1, 0, 0}, {0.5, h, 0}}}) == Approx(1.0));
    CHECK(radius_ratio(Triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}) ==
          Approx(2.0 * (1.0 - leg) / leg));
    CHECK(radius_ratio(Triangle{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}}) == 0.0);
    CHECK(radius_ratio(Tet{{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}}) == Approx(1.0));
    // The corner of a cube: r = V / (A/3) with V = 1/6, A = 3/2 + √3/2; R = √3/2.
    CHECK(radius_ratio(Tet{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}) ==
          Approx(3.0 * 0.5 / (1.5 + h) / h));
    CHECK(radius_ratio(Tet{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}}) == 0.0);
    // Size and orientation do not matter.
    CHECK(mean_ratio(Tet{{{5, 5, 5}, {5, -5, -5}, {-5, -5, 5}, {-5, 5, -5}}}) == Approx(1.0));
}
