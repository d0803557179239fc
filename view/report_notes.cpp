#include "view/report_notes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "view/markup.h"

namespace tyndall::view {
namespace {

// Linear functions follow zones of up to so many optical depths (docs/limits.md).
constexpr double thick = 2.0;
// A balance or closure that is off by more is worth a word [-].
constexpr double unbalanced = 0.01;

bool warned(const radiosity::Report& report, const std::string& words) {
    return std::any_of(report.warnings.begin(), report.warnings.end(), [&](const auto& warning) {
        return warning.find(words) != std::string::npos;
    });
}

double escaped_power(const radiosity::Report& report) {
    double sum = 0.0;
    if (const auto found = report.net_power.find("outside"); found != report.net_power.end())
        for (const double value : found->second) sum += value;
    return sum;
}

void note_errors(const radiosity::Report& r, double goal, std::vector<std::string>& notes) {
    const bool said = warned(r, "error goal") || warned(r, "max_time");
    if (goal > 0.0 && r.estimated_error > goal && !said)
        notes.push_back(
            fmt::format("The estimated error, {}, is above the goal of {}: allow more elements "
                        "(solve.max_elements) or rays (solve.gather_rays), or be content with it.",
                        percent(r.estimated_error), percent(goal)));
    if (r.stopped && !warned(r, "stopped") && !said)
        notes.emplace_back(
            "The solve was stopped before its end: the solution is valid, but coarser than it "
            "should be. Go on with it: tyndall run SCENE -o DIR --resume.");
    if (std::abs(r.energy_balance) > unbalanced)
        notes.push_back(
            fmt::format("{} of the power brought in is not accounted for: raise solve.rays, or set "
                        "solve.smoothing, which makes rows close and reciprocal.",
                        percent(std::abs(r.energy_balance))));
    if (r.closure_error > unbalanced && !warned(r, "rows close"))
        notes.push_back(fmt::format(
            "A row of exchange areas misses its capacity by {}: raise solve.rays, or set "
            "solve.smoothing.",
            percent(r.closure_error)));
    if (r.lost_rays > 0)
        notes.push_back(fmt::format(
            "{} rays were given up after too many steps: faces of the scene may nearly coincide. "
            "tyndall check tells what was conformed.",
            r.lost_rays));
}

}  // namespace

std::vector<std::string> report_notes(const radiosity::Solution& solution, const ReportFacts& facts,
                                      const MeshStatistics& mesh, double goal) {
    const radiosity::Report& r = facts.report;
    std::vector<std::string> notes;
    if (solution.enclosure->open) {
        const double net = escaped_power(r);
        notes.push_back(fmt::format(
            "The scene is open: {} W {} through its hull. If it should be closed, tyndall check "
            "tells where the hull is open.",
            figure(std::abs(net)), net < 0.0 ? "come in on balance" : "leave on balance"));
    }
    const auto thickest = spread_of(mesh.zone_thickness);
    if (thickest.most > thick && !warned(r, "optical depths thick"))
        notes.push_back(fmt::format(
            "Zones are up to {} optical depths thick, where a linear function is too little: lower "
            "solve.element_size, or solve.error.",
            figure(thickest.most)));
    note_errors(r, goal, notes);
    return notes;
}

}  // namespace tyndall::view
