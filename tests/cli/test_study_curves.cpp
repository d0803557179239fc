// Slopes, costs for an error, tables and plots of studies, on data made for it.
#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/probe_values_file.h"
#include "cli/study_histories.h"
#include "cli/study_plot.h"
#include "cli/study_summary.h"
#include "cli/study_table.h"
#include "mesh/input_error.h"
#include "render/mesh_pictures.h"
#include "support/catch.h"
#include "support/well_formed.h"

using namespace tyndall;
using namespace tyndall::cli;
using test::well_formed;

namespace {

Curve power_law(double exponent, std::vector<double> costs) {
    Curve curve{"law", {}};
    for (const double cost : costs) curve.points.push_back({cost, 3.0 * std::pow(cost, exponent)});
    return curve;
}

// A row of a study of solve.error whose picture is off by `error`.
StudyRow row(const std::string& curve, double along, std::size_t zones, double error) {
    StudyRow row;
    row.run.cells = {std::to_string(along)};
    row.run.slug = curve + "-" + std::to_string(zones);
    row.run.curve = curve;
    row.run.along = along;
    row.record.figures.zones = zones;
    row.record.figures.cpu_seconds = 0.001 * static_cast<double>(zones);
    row.record.errors["picture"] = {error, -error, 0.5 * error, 0.1 * error};
    row.record.measured["picture"] = "key";
    return row;
}

Study study_of_error() {
    Study study;
    study.title = "made <up> & \"quoted\"";
    study.scene = "scene.toml";
    study.measures = {StudyMeasure{}};
    study.matrices = {{"", {{"solve.error", {{"0.1", "0.1", 0.1, ""}}, ""}}, 0}};
    study.errors = {0.01};
    return study;
}

}  // namespace

TEST_CASE("A power law's exponent is found") {
    for (const double p : {-2.0, -0.5, -1.0 / 3.0, 0.25})
        CHECK(*fitted_slope(power_law(p, {10, 100, 1000, 50000})) == Approx(p).margin(1e-12));
    CHECK_FALSE(fitted_slope(power_law(-1.0, {10})));
    CHECK_FALSE(fitted_slope(power_law(-1.0, {10, 10, 10})));
    CHECK_FALSE(fitted_slope({}));
    // By least squares of the logarithms: (1, 1), (10, 0.01), (100, 0.01) in logs 0, −2, −2.
    CHECK(*fitted_slope({"", {{1, 1}, {10, 0.01}, {100, 0.01}}}) == Approx(-1.0));
}

TEST_CASE("The cost of an error is interpolated; beyond the runs there are bounds and guesses") {
    const Curve curve = power_law(-0.5, {100, 1000, 10000});  // 0.3, 0.095, 0.03
    const Need need = needed_for(curve, 0.05);
    CHECK(need.kind == Need::Kind::at);
    CHECK(need.cost == Approx(3600.0));  // (3 / 0.05)²: exact on a power law
    CHECK(needed_for(curve, 0.02).kind == Need::Kind::more_than);
    CHECK(needed_for(curve, 0.02).cost == 10000.0);
    CHECK(*needed_for(curve, 0.02).by_slope == Approx(22500.0));            // (3 / 0.02)²
    CHECK_FALSE(needed_for(power_law(-0.05, {100, 1000}), 0.02).by_slope);  // too flat to say
    CHECK_FALSE(needed_for(power_law(-0.5, {100}), 0.02).by_slope);
    CHECK(needed_for(curve, 0.5).kind == Need::Kind::at_most);
    CHECK(needed_for(curve, 0.5).cost == 100.0);
    // A dip that does not last does not count; the order of the points does not matter.
    const Curve dip{"", {{1000, 0.001}, {100, 0.1}, {10000, 0.1}, {100000, 0.001}}};
    CHECK(needed_for(dip, 0.01).cost == Approx(std::sqrt(1e4 * 1e5)));
}

TEST_CASE("Curves leave out what failed and what has no error") {
    std::vector<StudyRow> rows{row("a", 0.01, 4000, 0.02), row("a", 0.1, 1000, 0.04),
                               row("b", 0.1, 500, 0.04), row("c", 0.1, 500, 0.0)};
    rows.push_back(row("b", 0.01, 900, 0.03));
    rows.back().record.failure = "no memory";
    const auto curves = curves_of(rows, "picture", Figure::block4, Cost::elements);
    REQUIRE(curves.size() == 2);
    CHECK(curves[0].name == "a");
    CHECK(curves[0].points[0].cost == 1000.0);  // from the coarse end
    CHECK(curves[0].points[1].error == 0.01);
    CHECK(curves[1].points.size() == 1);
    CHECK(curves_of(rows, "probe", Figure::rmse, Cost::elements).empty());
}

TEST_CASE("Tables have a cell a column in every row") {
    const auto study = study_of_error();
    std::vector<StudyRow> rows{row("a", 0.1, 1000, 0.04), row("a", 0.01, 4000, 0.005)};
    rows.push_back(row("a", 0.001, 1, 0.1));
    rows.back().record.failure = "it said \"no\", and\nended";
    const auto csv = study_csv(study, rows);
    CHECK(csv.rfind("solve.error,patches,zones,rays,cpu_seconds,wall_seconds,memory_bytes,"
                    "picture_rmse,picture_bias,picture_block4,picture_block16,tet_quality_min",
                    0) == 0);
    CHECK_THAT(csv, Contains("\"it said \"\"no\"\", and ended\""));
    std::size_t line_count = 0;
    for (const char c : csv) line_count += c == '\n';
    CHECK(line_count == 4);
    const auto first = csv.substr(0, csv.find('\n'));
    const auto second = csv.substr(first.size() + 1, csv.find('\n', first.size() + 1));
    CHECK(std::count(first.begin(), first.end(), ',') ==
          std::count(second.begin(), second.begin() + static_cast<long>(second.find('\n')), ','));

    const auto targets = targets_csv(targets_of(study, rows));
    CHECK_THAT(targets, Contains("picture,rmse,0.01,a,2519"));  // 1000 · 4^(ln 4 / ln 8) = 2519.8
    CHECK_THAT(targets, Contains("picture,block16,0.01,a,<=1000"));
    const auto json = nlohmann::json::parse(study_json(study, rows));
    CHECK(json.at("rows").size() == 3);
    CHECK(json.at("rows")[1].at("picture_rmse") == 0.005);
    CHECK(json.at("rows")[2].at("zones").is_null());
    CHECK(json.at("targets").size() == 3);
    const auto summary = summary_of({}, study, rows);
    CHECK_THAT(summary, Contains("1 of which failed") && Contains("### picture: RMSE") &&
                            Contains("| a | 2520; 2.52 s |"));
}

TEST_CASE("Plots are well-formed, with axes, ticks, units and a legend of slopes") {
    Plot plot{"made <up> & \"quoted\"", "elements", "RMSE [%]", {}, {0.1}};
    CHECK(well_formed(svg_of(plot)));
    CHECK_THAT(svg_of(plot), Contains("no run to show"));
    for (int k = 0; k < 9; ++k) {
        plot.curves.push_back(power_law(-0.5, {100, 1000, 20000}));
        plot.curves.back().name = "a<b & " + std::to_string(k);
    }
    const auto svg = svg_of(plot);
    CHECK(well_formed(svg));
    CHECK_FALSE(well_formed(svg + "<g>"));  // the check can fail
    CHECK_THAT(svg, Contains("slope −0.50") && Contains("a&lt;b &amp; 8") && Contains(">1000<") &&
                        Contains(">10⁴<") && Contains("RMSE [%]") && Contains("stroke-dasharray"));
    CHECK(svg.find("nan") == svg.npos);
    // One point, and points of one value, have axes too.
    plot.curves = {{"one", {{50, 0.02}}}};
    CHECK(svg_of(plot).find("nan") == std::string::npos);
    CHECK(svg_of(plot).find("inf") == std::string::npos);
}

TEST_CASE("Solver histories are curves of the slowest band, drawn on a linear axis of passes") {
    std::vector<radiosity::SolverStep> history;
    for (std::size_t band = 0; band < 2; ++band)
        for (std::size_t k = 0; k <= 30 + 20 * band; ++k) {
            radiosity::SolverStep step;
            step.band = band;
            step.iterations = k;
            step.cpu_seconds = 0.01 * double(k);
            step.residual = std::pow(0.5, double(k));
            history.push_back(step);
        }
    const HistoryPlot *passes = nullptr, *seconds = nullptr;
    for (const auto& plot : history_plots()) {
        if (plot.file == "solver_residual_iterations.svg") passes = &plot;
        if (plot.file == "solver_residual_cpu.svg") seconds = &plot;
    }
    REQUIRE(passes);
    REQUIRE(seconds);
    const Curve curve = history_curve("jacobi", history, 100, *passes);
    REQUIRE(curve.points.size() == 51);
    CHECK(curve.points[0].cost == 0.0);
    CHECK(curve.points[50].error == std::pow(0.5, 50.0));
    // There is no 0 on a logarithmic axis of seconds.
    CHECK(history_curve("jacobi", history, 100, *seconds).points.size() == 50);
    CHECK(history_curve("none", {}, 100, *passes).points.empty());

    radiosity::SolverStep shot;
    shot.iterations = 1, shot.shots = 25;
    CHECK(history_curve("shots", {shot}, 100, *passes).points.at(0).cost == 0.25);

    Plot plot{"solvers", "passes", "residual [-]", {curve}, {}};
    plot.times = 1.0, plot.slopes = false, plot.marks = 12, plot.linear_x = true;
    const auto svg = svg_of(plot);
    CHECK(well_formed(svg));
    CHECK_THAT(svg, Contains(">0<") && Contains(">50<") && Contains(">1<") && Contains("jacobi"));
    CHECK(svg.find("slope") == svg.npos);
    std::size_t marks = 0;
    for (auto at = svg.find("<circle"); at != svg.npos; at = svg.find("<circle", at + 1)) ++marks;
    CHECK(marks <= 13);  // and one in the legend
    CHECK(marks > 6);

    auto study = study_of_error();
    CHECK_FALSE(compares_solvers(study));
    study.matrices[0].axes[0].key = "solve.solver";
    CHECK(compares_solvers(study));
}

TEST_CASE("Probe values are read as tyndall probe writes them") {
    const auto in_space =
        parse_probe_values("x,y,z,J,J_direct,G,G_direct\n1,2,3,0.5,0.1,7,8\n", "p");
    CHECK(in_space.points.at(0).x == mesh::Point(1, 2, 3));
    CHECK_FALSE(in_space.points[0].on_side());
    CHECK(in_space.values.at(0) == radiosity::Spectrum{0.5});
    const auto on_sides =
        parse_probe_values("# walls\nx,y,z,nx,ny,nz,E_0,E_1\n0,0,0,0,0,1,3,4\n\n", "p");
    CHECK(on_sides.points.at(0).normal == mesh::Direction(0, 0, 1));
    CHECK(on_sides.values.at(0) == radiosity::Spectrum{3.0, 4.0});
    for (const char* text : {"", "x,y,z,J\n", "x,y,J\n1,2,3\n", "x,y,z\n1,2,3\n",
                             "x,y,z,J\n1,2,3\n", "x,y,z,J\n1,2,3,nan\n", "x,y,z,J\n1,2,3,a\n"})
        CHECK_THROWS_AS(parse_probe_values(text, "p"), mesh::InputError);
}
