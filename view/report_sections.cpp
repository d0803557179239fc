#include "view/report_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "view/charts.h"
#include "view/markup.h"

namespace tyndall::view {
namespace {

using radiosity::PassReport;
using radiosity::Report;

void add(Table& table, const std::string& name, const std::string& value) {
    table.rows.push_back({name, value});
}

std::string count(std::size_t n) {
    return std::to_string(n);
}

std::string parts_text(const radiosity::ErrorParts& parts) {
    return fmt::format("{} (elements {}, gathers {}, coarse solution {})", percent(parts.total()),
                       percent(parts.elements), percent(parts.gathers), percent(parts.coarse));
}

std::string solver_text(const radiosity::SolverReport& solver) {
    if (solver.method.empty()) return "not known";
    return fmt::format("{}, {} iterations, residual {}{}", solver.method, solver.iterations,
                       figure(solver.residual), solver.converged ? "" : ", not converged");
}

void add_costs(Table& table, const ReportFacts& f) {
    if (f.wall_seconds > 0.0)
        add(table, "time",
            fmt::format("{}, {} of CPU", seconds(f.wall_seconds), seconds(f.cpu_seconds)));
    if (f.peak_memory_bytes > 0.0) add(table, "most memory", megabytes(f.peak_memory_bytes));
    if (f.threads > 0) add(table, "threads", count(f.threads));
}

std::vector<std::string> pass_row(const PassReport& pass, bool costs) {
    std::vector<std::string> row{
        pass.stage, count(pass.patches), count(pass.zones), count(pass.rays),
        pass.estimated_error > 0.0 ? percent(pass.estimated_error) : "not known yet"};
    if (!costs) return row;
    row.push_back(seconds(pass.wall_seconds));
    row.push_back(seconds(pass.cpu_seconds));
    row.push_back(megabytes(static_cast<double>(pass.memory_bytes)));
    return row;
}

// Curves over the passes; a point is left out where something is not known.
ChartCurve over_passes(const std::vector<PassReport>& passes, const std::string& name, auto&& x,
                       auto&& y) {
    ChartCurve curve{name, {}};
    for (std::size_t k = 0; k < passes.size(); ++k)
        curve.points.push_back({x(k), static_cast<double>(y(passes[k]))});
    return curve;
}

double total(const radiosity::Spectrum& spectrum) {
    double sum = 0.0;
    for (const double value : spectrum) sum += value;
    return sum;
}

std::string per_size(const std::map<std::string, radiosity::Spectrum>& values,
                     const std::string& name) {
    const auto found = values.find(name);
    return found == values.end() ? "" : figure(total(found->second));
}

// Power given, by name. What report.json calls `outside` is what leaves the scene: that is taken.
std::map<std::string, radiosity::Spectrum> powers_of(const Report& report) {
    auto powers = report.net_power;
    if (const auto outside = powers.find("outside"); outside != powers.end())
        for (double& value : outside->second) value = value == 0.0 ? 0.0 : -value;
    return powers;
}

// The largest, so that a chart of a scene of many parts can be read.
std::vector<ChartBar> largest_powers(const Report& report) {
    constexpr std::size_t most = 24;
    std::vector<ChartBar> bars;
    for (const auto& [name, power] : powers_of(report)) bars.push_back({name, total(power)});
    std::stable_sort(bars.begin(), bars.end(), [](const ChartBar& a, const ChartBar& b) {
        return std::abs(a.value) > std::abs(b.value);
    });
    if (bars.size() > most) bars.resize(most);
    return bars;
}

std::string bands_table(const Report& report, std::size_t bands) {
    Table table{"Net power in each band [W]", {"name"}, {}};
    for (std::size_t b = 0; b < bands; ++b) table.heads.push_back(fmt::format("band {}", b + 1));
    for (const auto& [name, power] : powers_of(report)) {
        std::vector<std::string> row{name};
        for (const double value : power) row.push_back(figure(value));
        table.rows.push_back(row);
    }
    return table_markup(table);
}

void add_sums(Table& table, const Report& report) {
    double gives = 0.0, takes = 0.0;
    for (const auto& [name, power] : powers_of(report))
        (total(power) > 0.0 ? gives : takes) += total(power);
    const auto row = [&](const char* name, double sum) {
        table.rows.push_back({name, figure(sum), "", ""});
    };
    row("sum of what gives", gives);
    row("sum of what takes", takes);
    row("sum of all", gives + takes);
}

std::string figure_markup(const std::string& caption, const std::string& chart,
                          const std::string& table, bool folded) {
    if (chart.empty() && table.empty()) return "";
    std::string text = "<figure><figcaption>" + escaped(caption) + "</figcaption>\n" + chart;
    if (!table.empty())
        text += folded && !chart.empty() ? folded_markup("Numbers of this chart", table)
                                         : "<div>" + table + "</div>";
    return text + "</figure>\n";
}

}  // namespace

std::string section(SectionLevel level, const std::string& id, const std::string& title,
                    const std::string& content) {
    if (content.empty()) return "";
    return fmt::format(
        "<section aria-labelledby=\"{0}\"><h{1} id=\"{0}\">{2}</h{1}>\n{3}</section>\n", id,
        level.heading, escaped(title), content);
}

std::string chart_figure(const std::string& caption, const std::string& chart,
                         const std::string& table) {
    return figure_markup(caption, chart, table, false);
}

std::string folded_figure(const std::string& caption, const std::string& chart,
                          const std::string& table) {
    return figure_markup(caption, chart, table, true);
}

std::string warnings_list(const ReportFacts& facts, const std::vector<std::string>& notes) {
    if (facts.report.warnings.empty() && notes.empty()) return "<p>There are no warnings.</p>\n";
    std::string text = "<ul class=\"warnings\">\n";
    for (const auto& warning : facts.report.warnings)
        text += "<li class=\"warning\"><strong>Warning:</strong> " + escaped(warning) + "</li>\n";
    for (const auto& note : notes) text += "<li class=\"note\">" + escaped(note) + "</li>\n";
    return text + "</ul>\n";
}

std::string solution_table(const ReportFacts& facts, double goal) {
    const Report& r = facts.report;
    Table table{"The solution", {"what", "value"}, {}, false};
    add(table, "patches", count(r.patches));
    add(table, "zones", count(r.zones));
    add(table, "elements of the coarse solution", count(r.solved_elements));
    add(table, "estimated error", percent(r.estimated_error));
    if (goal > 0.0) add(table, "goal of the error", percent(goal));
    if (r.picture_error) add(table, "estimated error of the picture", parts_text(*r.picture_error));
    add(table, "estimated error of the solution", parts_text(r.solution_error));
    add(table, "solver", solver_text(r.solver));
    add(table, "closure error", figure(r.closure_error));
    add(table, "reciprocity error", figure(r.reciprocity_error));
    if (r.smoothing)
        add(table, "before smoothing",
            fmt::format("closure error {}, reciprocity error {}",
                        figure(r.smoothing->raw_closure_error),
                        figure(r.smoothing->raw_reciprocity_error)));
    add(table, "energy balance, missed", percent(r.energy_balance));
    add(table, "direct power, too much", percent(r.direct_power_check));
    if (r.lost_rays > 0) add(table, "rays that were given up", count(r.lost_rays));
    add_costs(table, facts);
    return table_markup(table);
}

std::string passes_figures(const ReportFacts& facts, double goal) {
    const auto& passes = facts.report.passes;
    if (passes.empty()) return "";
    bool costs = false;
    for (const auto& pass : passes) costs = costs || pass.wall_seconds > 0.0;
    Table table{"Passes: elements, estimated error and cost of each",
                {"pass", "patches", "zones", "rays", "estimated error"},
                {}};
    if (costs) table.heads.insert(table.heads.end(), {"time", "CPU time", "memory"});
    for (const auto& pass : passes) table.rows.push_back(pass_row(pass, costs));
    std::vector<double> spent(passes.size());
    for (std::size_t k = 0; k < passes.size(); ++k)
        spent[k] = (k > 0 ? spent[k - 1] : 0.0) + passes[k].wall_seconds;
    const auto elements = [&](std::size_t k) {
        return static_cast<double>(passes[k].patches + passes[k].zones);
    };
    const auto error = [](const PassReport& p) { return 100.0 * p.estimated_error; };
    const ChartLevel level{"goal", 100.0 * goal};
    std::string charts = folded_figure(
        "Estimated error over elements",
        curve_chart({"Estimated error over elements",
                     "A point a pass, both axes logarithmic; the numbers stand in the table of "
                     "passes.",
                     "elements", "estimated error [%]"},
                    {over_passes(passes, "error", elements, error)}, AxisScale::logarithmic, level),
        "");
    if (costs) {
        charts += folded_figure(
            "Estimated error over time",
            curve_chart({"Estimated error over time",
                         "A point a pass, both axes logarithmic; the numbers stand in the table of "
                         "passes.",
                         "time since the solve began [s]", "estimated error [%]"},
                        {over_passes(
                            passes, "error", [&](std::size_t k) { return spent[k]; }, error)},
                        AxisScale::logarithmic, level),
            "");
        charts += folded_figure(
            "Time and memory over elements",
            curve_chart(
                {"Time and memory over elements",
                 "Two curves, a point a pass, both axes logarithmic; the numbers stand in the "
                 "table of passes.",
                 "elements", "s, MB"},
                {over_passes(passes, "time of the pass [s]", elements,
                             [](const PassReport& p) { return p.wall_seconds; }),
                 over_passes(passes, "memory [MB]", elements,
                             [](const PassReport& p) {
                                 return 1e-6 * static_cast<double>(p.memory_bytes);
                             })},
                AxisScale::logarithmic),
            "");
    }
    return table_markup(table) + "<div class=\"charts\">" + charts + "</div>\n";
}

std::string solver_figures(const ReportFacts& facts) {
    const auto& solver = facts.report.solver;
    if (solver.history.empty()) return "";
    constexpr std::size_t most = 6;  // curves that can be told apart
    Table table{"The residual after passes over the rows", {"iterations", "residual"}, {}};
    std::vector<ChartCurve> curves;
    const bool bands = solver.history.back().band > 0;
    if (bands) table.heads.insert(table.heads.begin(), "band");
    for (const auto& step : solver.history) {
        if (step.band >= curves.size()) curves.resize(step.band + 1);
        curves[step.band].name = fmt::format("band {}", step.band + 1);
        curves[step.band].points.push_back({static_cast<double>(step.iterations), step.residual});
        std::vector<std::string> row{count(step.iterations), figure(step.residual)};
        if (bands) row.insert(row.begin(), count(step.band + 1));
        table.rows.push_back(row);
    }
    if (curves.size() > most) curves.resize(most);
    const auto title = fmt::format("How {} converged", solver.method);
    return folded_figure(
        title,
        curve_chart({title,
                     fmt::format("The residual falls to {} in {} iterations; a logarithmic axis.",
                                 figure(solver.residual), solver.iterations),
                     "iterations", "residual"},
                    curves, AxisScale::linear),
        table_markup(table));
}

std::string power_figures(const ReportFacts& facts, const std::map<std::string, NamedSize>& sizes) {
    const Report& r = facts.report;
    if (r.net_power.empty()) return "";
    Table table{"Net power by name: positive gives, negative takes",
                {"name", "net power [W]", "area or volume", "over it"},
                {}};
    std::size_t bands = 1;
    for (const auto& [name, power] : powers_of(r)) {
        bands = std::max(bands, power.size());
        const auto size = sizes.find(name);
        std::string extent, density;
        if (size != sizes.end() && size->second.volume) {
            extent = figure(size->second.size) + " m³";
            density = per_size(r.flux_divergence, name) + " W/m³";
        } else if (size != sizes.end()) {
            extent = figure(size->second.size) + " m²";
            density = per_size(r.net_flux, name) + " W/m²";
        }
        if (density.starts_with(' ')) density.clear();
        table.rows.push_back({name, figure(total(power)), extent, density});
    }
    add_sums(table, r);
    const auto bars = largest_powers(r);
    const std::string title = bars.size() < r.net_power.size()
                                  ? fmt::format("Net power, the {} largest", bars.size())
                                  : "Net power by name";
    return "<div class=\"beside\">" +
           chart_figure(title,
                        bar_chart({title,
                                   "Bars to the right give light, bars to the left take it; "
                                   "the numbers stand in the table beside.",
                                   "W", ""},
                                  bars),
                        table_markup(table)) +
           "</div>\n<p>The sum of all is what the balance misses, less what sun, point and spot "
           "lights bring in.</p>\n" +
           (bands > 1 ? bands_table(r, bands) : "");
}

std::string temperature_table(const ReportFacts& facts) {
    Table table{"Temperatures [K]: mean by area or volume, lowest and highest",
                {"name", "mean", "lowest", "highest"},
                {}};
    for (const auto& [name, range] : facts.report.temperature)
        table.rows.push_back(
            {name, figure(range.mean), figure(range.lowest), figure(range.highest)});
    return table_markup(table);
}

std::map<std::string, NamedSize> named_sizes(const radiosity::Enclosure& e) {
    std::map<std::string, NamedSize> sizes;
    for (const auto& side : e.sides) sizes[side.name] = {side.area, false};
    for (const auto& medium : e.media) sizes[medium.name] = {0.0, true};
    for (std::size_t t = 0; t < e.mesh.tets.size(); ++t) {
        const mesh::TetId tet(t);
        if (const auto medium = e.medium_of(tet); medium != radiosity::none && !e.solid(tet))
            sizes[e.media[medium].name].size += mesh::volume(e.mesh, tet);
    }
    return sizes;
}

}  // namespace tyndall::view
