#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/job.h"
#include "cli/suggestion.h"
#include "mesh/file_bytes.h"
#include "mesh/input_error.h"
#include "radiosity/exchange_methods.h"
#include "radiosity/exchange_table.h"
#include "radiosity/report_json.h"
#include "radiosity/smoothing.h"

namespace tyndall::cli {
namespace {

using Json = nlohmann::ordered_json;
using radiosity::ExchangeTable;

struct PairOptions {
    std::string scene, method, out;
    std::vector<std::string> from, to;
    std::optional<double> tolerance;
    std::optional<std::size_t> rays;
};

// Sides and media are few: more rays than the elements of a solve have.
constexpr std::size_t default_rays = 4096;

// The participants that a name means: itself, its two sides, or all sides of its parts.
std::vector<std::string> meant(const std::string& name, const std::vector<std::string>& known) {
    std::vector<std::string> found;
    for (const auto& candidate : known)
        if (candidate == name || candidate == name + "+" || candidate == name + "-" ||
            candidate.starts_with(name + "."))
            found.push_back(candidate);
    if (found.empty())
        throw mesh::InputError(fmt::format("nothing here that exchanges light is called \"{}\". {}",
                                           name, suggest(name, known)));
    return found;
}

std::vector<std::string> chosen(const std::vector<std::string>& names,
                                const std::vector<std::string>& known) {
    if (names.empty()) return known;
    std::vector<std::string> all;
    for (const auto& name : names)
        for (const auto& one : meant(name, known))
            if (std::ranges::find(all, one) == all.end()) all.push_back(one);
    return all;
}

radiosity::ExchangeOptions options_of(const PairOptions& given, const SceneFile& file,
                                      const CommonFlags& flags) {
    radiosity::ExchangeOptions options;
    const bool rays_set = std::ranges::any_of(
        flags.settings, [](const Setting& setting) { return setting.key == "solve.rays"; });
    options.rays = given.rays.value_or(rays_set ? file.solve.rays : default_rays);
    options.seed = file.solve.seed;
    options.settings = file.solve.exchange_settings;
    if (given.tolerance) options.settings.tolerance = *given.tolerance;
    return options;
}

std::vector<std::string> area_columns(std::size_t bands) {
    if (bands == 1) return {"exchange_area"};
    std::vector<std::string> columns;
    for (std::size_t b = 0; b < bands; ++b) columns.push_back(fmt::format("exchange_area_{}", b));
    return columns;
}

std::string as_csv(const ExchangeTable& table, std::size_t bands) {
    auto text = fmt::format("from,to,{}\n", fmt::join(area_columns(bands), ","));
    for (const auto& entry : table.entries)
        fmt::format_to(std::back_inserter(text), "{},{},{}\n", entry.from, entry.to,
                       fmt::join(entry.exchange_area, ","));
    return text;
}

Json as_json(const ExchangeTable& table, const std::string& method) {
    Json entries = Json::array();
    for (const auto& entry : table.entries)
        entries.push_back(
            {{"from", entry.from}, {"to", entry.to}, {"exchange_area", entry.exchange_area}});
    const auto known = [](double value) { return std::isnan(value) ? Json() : Json(value); };
    Json json{{"method", method},
              {"entries", entries},
              {"closure_error", known(table.closure_error)},
              {"reciprocity_error", known(table.reciprocity_error)}};
    if (table.smoothing)
        json["smoothing"] = Json::parse(radiosity::smoothing_to_json(*table.smoothing));
    json["lost_rays"] = table.lost_rays;
    return json;
}

std::string checks(const ExchangeTable& table) {
    const auto text = [](double value) {
        return std::isnan(value) ? std::string("not known from these pairs")
                                 : fmt::format("{:.2g}", value);
    };
    if (!table.smoothing)
        return fmt::format("closure error     {}\nreciprocity error {}\n",
                           text(table.closure_error), text(table.reciprocity_error));
    const radiosity::SmoothingReport& s = *table.smoothing;
    return fmt::format(
        "closure error     {} raw, {} smoothed{}\nreciprocity error {} raw, {} smoothed\n"
        "smoothing         {}: rows moved by {:.2g} at most, {:.2g} in the mean\n",
        text(s.raw_closure_error), text(table.closure_error),
        s.converged ? "" : ": rows cannot be made to close; try more rays",
        text(s.raw_reciprocity_error), text(table.reciprocity_error),
        radiosity::smoothing_name(s.method), s.moved_max, s.moved_mean);
}

int exchange(const PairOptions& given, const CommonFlags& flags) {
    SceneFile file = load_scene(given.scene, flags);
    if (!given.method.empty()) file.solve.exchange = given.method;
    file.mirrors = radiosity::Mirrors::scattered;  // exchange areas are those of shapes
    const auto& method = radiosity::exchange_method(file.solve.exchange);
    ProgressLine progress(flags);
    const auto enclosure = mesh_scene(file, progress);
    const auto known = radiosity::exchange_names(*enclosure);
    auto options = options_of(given, file, flags);
    // Half a table is none: a stop ends the command.
    options.progress = [shown = progress.callback()](const radiosity::Progress& at) {
        if (!shown(at)) throw mesh::InputError("stopped on request: nothing was written.");
        return true;
    };
    const auto table = radiosity::exchange_table(
        *enclosure, method, options, chosen(given.from, known), chosen(given.to, known));
    progress.clear();
    const auto csv = as_csv(table, enclosure->bands);
    if (!given.out.empty()) mesh::write_file(given.out, csv);
    if (flags.json)
        write_output(as_json(table, file.solve.exchange).dump(2) + "\n");
    else if (given.out.empty())
        write_output(csv);
    else if (!flags.quiet)
        write_output(fmt::format("wrote    {} ({} pairs)\n", given.out, table.entries.size()));
    if (!flags.quiet && !flags.json) fmt::print(stderr, "{}", checks(table));
    return 0;
}

}  // namespace

void add_exchange_command(Shell& shell) {
    const auto options = std::make_shared<PairOptions>();
    auto command = shell.add_command(
        "exchange", "Exchange areas between sides, media and outside",
        R"(  tyndall exchange room.toml
  tyndall exchange room.toml --from ceiling_lamp --to room.floor --to haze
  tyndall exchange room.toml --method hemicube --from room.floor --to room.ceiling)",
        [options](const CommonFlags& flags) { return exchange(*options, flags); });
    add_seed_flag(command, shell.flags());
    add_set_flag(command, shell.flags());
    command.option("SCENE", options->scene, "Scene file").required().file({"toml"});
    std::vector<std::string> methods;
    for (const auto& method : radiosity::exchange_methods()) methods.emplace_back(method.name);
    command
        .option("--method", options->method,
                "How exchange areas are computed; solve.exchange if not given")
        .word_of(methods);
    command.option("--from", options->from,
                   "A side (floor+), a surface (floor: its sides), a medium, or outside; "
                   "repeatable; all if not given");
    command.option("--to", options->to, "As --from");
    command
        .option("--tolerance", options->tolerance,
                "Relative, for the methods that have one; 1e-6 if not given")
        .between(1e-14, 0.5);
    command
        .option("--rays", options->rays,
                "For the methods that walk, from each facet and tetrahedron of the base mesh in "
                "the mean (2^20 at most from a side or medium); 4096 if not given")
        .between(std::size_t(1), std::size_t(1) << 24);
    command.option("-o,--output", options->out, "CSV to write; else standard output").file({"csv"});
}

}  // namespace tyndall::cli
