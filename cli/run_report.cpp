#include "cli/run_report.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <nlohmann/json.hpp>

#include "radiosity/report_json.h"
#include "radiosity/resources.h"

namespace tyndall::cli {

using Json = nlohmann::ordered_json;

std::string command_line(const std::vector<std::string>& words) {
    constexpr const char* plain =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./=:,+@%-";
    std::string line;
    for (const auto& word : words) {
        if (!line.empty()) line += ' ';
        if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) {
            line += word;
            continue;
        }
        line += '\'';
        for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
        line += '\'';
    }
    return line;
}

std::size_t threads_in_use() {
    return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}

std::string report_text(const radiosity::Report& report, const RunFacts& facts) {
    const auto solved = Json::parse(radiosity::report_to_json(report, radiosity::Costs::kept));
    Json json{{"scene", facts.scene},
              {"version", TYNDALL_VERSION},
              {"seed", facts.seed},
              {"threads", facts.threads}};
    if (!facts.command.empty()) json["command"] = facts.command;
    if (!facts.resumed_from.empty()) json["resumed_from"] = facts.resumed_from.string();
    for (const char* key : {"patches", "zones", "solved_elements", "passes"})
        json[key] = solved.at(key);
    json["cpu_seconds"] = radiosity::cpu_seconds();
    json["wall_seconds"] = radiosity::wall_seconds() - facts.began;
    json["peak_memory_bytes"] = radiosity::peak_memory_bytes();
    for (const auto& [key, value] : solved.items())
        if (!json.contains(key)) json[key] = value;
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string summary_text(const radiosity::Report& report, const RunFacts& facts) {
    std::string text;
    if (!facts.resumed_from.empty())
        text += fmt::format("resumed  {}\n", facts.resumed_from.string());
    text += fmt::format("mesh     {} patches, {} zones, after {} passes\n", report.patches,
                        report.zones, report.passes.size());
    text += fmt::format("error    {:.3g} % estimated\n", 100.0 * report.estimated_error);
    text += fmt::format("solver   {}, {} iterations, residual {:.1e}{}\n", report.solver.method,
                        report.solver.iterations, report.solver.residual,
                        report.solver.converged ? "" : ", not converged");
    text += fmt::format("checks   energy balance {:.1e}, direct power {:.1e}, closure {:.1e}\n",
                        report.energy_balance, report.direct_power_check, report.closure_error);
    if (const auto& s = report.smoothing)
        text += fmt::format(
            "rows     moved by {:.1e} in the mean, {:.1e} at most, to mend reciprocity ({:.1e}) "
            "and "
            "closure ({:.1e})\n",
            s->moved_mean, s->moved_max, s->raw_reciprocity_error, s->raw_closure_error);
    text += fmt::format("cost     {:.1f} s, {:.1f} CPU s, {:.0f} MB\n",
                        radiosity::wall_seconds() - facts.began, radiosity::cpu_seconds(),
                        static_cast<double>(radiosity::peak_memory_bytes()) / 1e6);
    for (const auto& warning : report.warnings) text += "warning  " + warning + "\n";
    for (const auto& path : facts.written) text += "wrote    " + path.string() + "\n";
    return text;
}

}  // namespace tyndall::cli
