#include "view/report_facts.h"

#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "mesh/input_error.h"
#include "radiosity/report_json.h"

namespace tyndall::view {
namespace {

// A solution that was saved while it was being solved has no report yet: what can be counted is,
// and the rest is not known.
void fill_unreported(const radiosity::Solution& solution, radiosity::Report& report) {
    if (!report.solver.method.empty()) return;
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    const auto leaves = radiosity::elements_of_leaves(*solution.enclosure, solution.forest);
    report.patches = leaves.patches.size();
    report.zones = leaves.zones.size();
    report.solved_elements = solution.coarse.elements.size();
    report.estimated_error = unknown;
    report.solution_error = {unknown, unknown, unknown};
    report.closure_error = report.reciprocity_error = unknown;
    report.energy_balance = report.direct_power_check = unknown;
}

}  // namespace

ReportFacts report_facts(const radiosity::Solution& solution, const std::string& report_json) {
    ReportFacts facts;
    if (report_json.empty()) {
        facts.report = solution.report;
        fill_unreported(solution, facts.report);
        return facts;
    }
    facts.report = radiosity::report_from_json(report_json);
    const auto json = nlohmann::json::parse(report_json);
    try {
        facts.scene = json.value("scene", "");
        facts.command = json.value("command", "");
        facts.resumed_from = json.value("resumed_from", "");
        if (json.contains("seed")) facts.seed = json.at("seed").get<std::uint64_t>();
        facts.threads = json.value("threads", std::size_t(0));
        facts.cpu_seconds = json.value("cpu_seconds", 0.0);
        facts.wall_seconds = json.value("wall_seconds", 0.0);
        facts.peak_memory_bytes = json.value("peak_memory_bytes", 0.0);
    } catch (const nlohmann::json::exception& error) {
        throw mesh::InputError(fmt::format("this is no report: {}.", error.what()));
    }
    return facts;
}

}  // namespace tyndall::view
