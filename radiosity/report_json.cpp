#include "radiosity/report_json.h"

#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "mesh/input_error.h"
#include "radiosity/smoothing.h"

namespace tyndall::radiosity {
namespace {

using Json = nlohmann::ordered_json;

// JSON knows no NaN and no infinity: they are written as null.
double number(const Json& json) {
    return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

Json pass_json(const PassReport& pass, Costs costs) {
    Json json{{"stage", pass.stage},
              {"patches", pass.patches},
              {"zones", pass.zones},
              {"rays", pass.rays},
              {"estimated_error", pass.estimated_error}};
    if (costs == Costs::kept) {
        json["cpu_seconds"] = pass.cpu_seconds;
        json["wall_seconds"] = pass.wall_seconds;
        json["memory_bytes"] = pass.memory_bytes;
    }
    return json;
}

PassReport pass_of(const Json& json) {
    PassReport pass;
    pass.stage = json.at("stage").get<std::string>();
    pass.patches = json.at("patches").get<std::size_t>();
    pass.zones = json.at("zones").get<std::size_t>();
    pass.rays = json.at("rays").get<std::size_t>();
    pass.estimated_error = number(json.at("estimated_error"));
    pass.cpu_seconds = json.value("cpu_seconds", 0.0);
    pass.wall_seconds = json.value("wall_seconds", 0.0);
    pass.memory_bytes = json.value("memory_bytes", std::size_t(0));
    return pass;
}

Json step_json(const SolverStep& step, Costs costs) {
    Json json{{"band", step.band},
              {"iterations", step.iterations},
              {"shots", step.shots},
              {"residual", step.residual},
              {"unshot_power", step.unshot_power},
              {"energy_balance", step.energy_balance},
              {"ambient", step.ambient}};
    if (costs == Costs::kept) json["cpu_seconds"] = step.cpu_seconds;
    return json;
}

SolverStep step_of(const Json& json) {
    SolverStep step;
    step.band = json.at("band").get<std::size_t>();
    step.iterations = json.at("iterations").get<std::size_t>();
    step.shots = json.at("shots").get<std::size_t>();
    step.cpu_seconds = json.value("cpu_seconds", 0.0);
    step.residual = number(json.at("residual"));
    step.unshot_power = number(json.at("unshot_power"));
    step.energy_balance = number(json.at("energy_balance"));
    step.ambient = number(json.at("ambient"));
    return step;
}

Json solver_json(const SolverReport& solver, Costs costs) {
    Json json{{"method", solver.method},     {"iterations", solver.iterations},
              {"residual", solver.residual}, {"converged", solver.converged},
              {"shots", solver.shots},       {"unshot_power", solver.unshot_power},
              {"history", Json::array()}};
    for (const auto& step : solver.history) json["history"].push_back(step_json(step, costs));
    return json;
}

SolverReport solver_of(const Json& json) {
    SolverReport solver;
    solver.method = json.at("method").get<std::string>();
    solver.iterations = json.at("iterations").get<std::size_t>();
    solver.residual = number(json.at("residual"));
    solver.converged = json.at("converged").get<bool>();
    // Files of earlier versions do not have these.
    solver.shots = json.value("shots", std::size_t(0));
    solver.unshot_power = number(json.value("unshot_power", Json(0.0)));
    for (const auto& step : json.value("history", Json::array()))
        solver.history.push_back(step_of(step));
    return solver;
}

Json spectrum_json(const Spectrum& spectrum) {
    return spectrum.size() == 1 ? Json(spectrum[0]) : Json(spectrum);
}

Spectrum spectrum_of(const Json& json) {
    if (!json.is_array()) return {number(json)};
    Spectrum spectrum;
    for (const Json& value : json) spectrum.push_back(number(value));
    return spectrum;
}

Json spectra_json(const std::map<std::string, Spectrum>& spectra) {
    Json json = Json::object();
    for (const auto& [name, spectrum] : spectra) json[name] = spectrum_json(spectrum);
    return json;
}

std::map<std::string, Spectrum> spectra_of(const Json& json, const char* key) {
    std::map<std::string, Spectrum> spectra;
    if (const auto found = json.find(key); found != json.end())
        for (const auto& [name, values] : found->items()) spectra[name] = spectrum_of(values);
    return spectra;
}

Json parts_json(const ErrorParts& parts) {
    return {{"elements", parts.elements}, {"gathers", parts.gathers}, {"coarse", parts.coarse}};
}

ErrorParts parts_of(const Json& json) {
    return {number(json.at("elements")), number(json.at("gathers")), number(json.at("coarse"))};
}

Json smoothing_json(const SmoothingReport& smoothing) {
    return {{"method", smoothing_name(smoothing.method)},
            {"raw_closure_error", smoothing.raw_closure_error},
            {"raw_reciprocity_error", smoothing.raw_reciprocity_error},
            {"moved_max", smoothing.moved_max},
            {"moved_mean", smoothing.moved_mean},
            {"clamped", smoothing.clamped},
            {"iterations", smoothing.iterations},
            {"converged", smoothing.converged}};
}

SmoothingReport smoothing_of(const Json& json) {
    SmoothingReport smoothing;
    smoothing.method = smoothing_named(json.at("method").get<std::string>());
    smoothing.raw_closure_error = number(json.at("raw_closure_error"));
    smoothing.raw_reciprocity_error = number(json.at("raw_reciprocity_error"));
    smoothing.moved_max = number(json.at("moved_max"));
    smoothing.moved_mean = number(json.at("moved_mean"));
    smoothing.clamped = json.at("clamped").get<std::size_t>();
    smoothing.iterations = json.at("iterations").get<std::size_t>();
    smoothing.converged = json.at("converged").get<bool>();
    return smoothing;
}

Report report_of(const Json& json) {
    Report report;
    report.patches = json.at("patches").get<std::size_t>();
    report.zones = json.at("zones").get<std::size_t>();
    report.solved_elements = json.at("solved_elements").get<std::size_t>();
    for (const auto& pass : json.at("passes")) report.passes.push_back(pass_of(pass));
    report.solver = solver_of(json.at("solver"));
    report.closure_error = number(json.at("closure_error"));
    report.reciprocity_error = number(json.at("reciprocity_error"));
    if (const auto smoothing = json.find("smoothing"); smoothing != json.end())
        report.smoothing = smoothing_of(*smoothing);
    report.energy_balance = number(json.at("energy_balance"));
    report.direct_power_check = number(json.at("direct_power_check"));
    report.net_power = spectra_of(json, "net_power");
    // Files of earlier versions do not have these three.
    report.net_flux = spectra_of(json, "net_flux");
    report.flux_divergence = spectra_of(json, "flux_divergence");
    if (const auto found = json.find("temperature"); found != json.end())
        for (const auto& [name, range] : found->items())
            report.temperature[name] = {number(range.at("mean")), number(range.at("lowest")),
                                        number(range.at("highest"))};
    report.estimated_error = number(json.at("estimated_error"));
    // Files of earlier versions do not have these.
    if (const auto parts = json.find("error_parts"); parts != json.end()) {
        report.solution_error = parts_of(parts->at("solution"));
        if (parts->contains("picture")) report.picture_error = parts_of(parts->at("picture"));
    }
    report.lost_rays = json.at("lost_rays").get<std::size_t>();
    report.stopped = json.at("stopped").get<bool>();
    report.warnings = json.at("warnings").get<std::vector<std::string>>();
    return report;
}

}  // namespace

std::string report_to_json(const Report& report, Costs costs) {
    Json json;
    json["patches"] = report.patches;
    json["zones"] = report.zones;
    json["solved_elements"] = report.solved_elements;
    json["passes"] = Json::array();
    for (const auto& pass : report.passes) json["passes"].push_back(pass_json(pass, costs));
    json["solver"] = solver_json(report.solver, costs);
    json["closure_error"] = report.closure_error;
    json["reciprocity_error"] = report.reciprocity_error;
    if (report.smoothing) json["smoothing"] = smoothing_json(*report.smoothing);
    json["energy_balance"] = report.energy_balance;
    json["direct_power_check"] = report.direct_power_check;
    json["net_power"] = spectra_json(report.net_power);
    json["net_flux"] = spectra_json(report.net_flux);
    json["flux_divergence"] = spectra_json(report.flux_divergence);
    for (const auto& [name, range] : report.temperature)
        json["temperature"][name] = {
            {"mean", range.mean}, {"lowest", range.lowest}, {"highest", range.highest}};
    json["estimated_error"] = report.estimated_error;
    json["estimated_picture_error"] =
        report.picture_error ? Json(report.picture_error->total()) : Json();
    json["estimated_solution_error"] = report.solution_error.total();
    json["error_parts"] = Json::object();
    if (report.picture_error) json["error_parts"]["picture"] = parts_json(*report.picture_error);
    json["error_parts"]["solution"] = parts_json(report.solution_error);
    json["lost_rays"] = report.lost_rays;
    json["stopped"] = report.stopped;
    json["warnings"] = report.warnings;
    return json.dump(1, ' ', false, Json::error_handler_t::replace);
}

std::string smoothing_to_json(const SmoothingReport& smoothing) {
    return smoothing_json(smoothing).dump();
}

Report report_from_json(const std::string& text) {
    try {
        return report_of(Json::parse(text));
    } catch (const Json::exception& error) {
        throw mesh::InputError(fmt::format("this is no report: {}.", error.what()));
    }
}

}  // namespace tyndall::radiosity
