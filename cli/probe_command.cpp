#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <iterator>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/job.h"
#include "cli/points_file.h"
#include "mesh/file_bytes.h"
#include "mesh/input_error.h"
#include "radiosity/probe.h"
#include "radiosity/solution_file.h"

namespace tyndall::cli {
namespace {

struct PointsOptions {
    std::string solution, points, out;
    std::size_t rays = 4096;
};

// Rows of numbers under their names, in the order of the points.
struct Table {
    std::vector<std::string> columns;
    std::vector<std::vector<double>> rows;
};

std::vector<std::string> columns_of(const PointsFile& points,
                                    const radiosity::Enclosure& enclosure) {
    const std::size_t bands = enclosure.bands;
    std::vector<std::string> columns{"x", "y", "z"};
    if (points.has_normals) columns.insert(columns.end(), {"nx", "ny", "nz"});
    const std::vector<std::string> quantities =
        points.has_normals ? std::vector<std::string>{"E", "E_direct"}
                           : std::vector<std::string>{"J", "J_direct", "G", "G_direct"};
    for (const auto& quantity : quantities)
        for (std::size_t b = 0; b < bands; ++b)
            columns.push_back(bands == 1 ? quantity : fmt::format("{}_{}", quantity, b));
    if (enclosure.thermal) columns.push_back("T");
    return columns;
}

std::vector<double> values_at(const radiosity::Probe& probe, const PointsFile::Row& point,
                              bool has_normal, bool thermal) {
    std::vector<double> row{point.x.x, point.x.y, point.x.z};
    const auto add = [&](const radiosity::Spectrum& spectrum) {
        row.insert(row.end(), spectrum.begin(), spectrum.end());
    };
    if (has_normal) {
        row.insert(row.end(), {point.normal.x, point.normal.y, point.normal.z});
        const auto values = probe.on_surface(point.x, point.normal);
        add(values.irradiance);
        add(values.irradiance_direct);
        if (thermal) row.push_back(values.temperature);
    } else {
        const auto values = probe.in_space(point.x);
        add(values.source);
        add(values.source_direct);
        add(values.incident);
        add(values.incident_direct);
        if (thermal) row.push_back(values.temperature);
    }
    return row;
}

Table probe_all(const radiosity::Solution& solution, const PointsFile& points,
                const PointsOptions& options, const CommonFlags& flags) {
    const radiosity::Probe probe(solution, {options.rays, flags.seed.value_or(1)});
    ProgressLine progress(flags);
    const auto callback = progress.callback();
    Table table{columns_of(points, *solution.enclosure), {}};
    table.rows.resize(points.rows.size());
    std::vector<std::string> errors(points.rows.size());
    std::atomic<std::size_t> done = 0;
    tbb::parallel_for(std::size_t(0), points.rows.size(), [&](std::size_t k) {
        if (progress.stopped()) return;
        try {
            table.rows[k] =
                values_at(probe, points.rows[k], points.has_normals, solution.enclosure->thermal);
        } catch (const mesh::InputError& error) {
            errors[k] = error.what();
        }
        const double fraction = double(++done) / double(points.rows.size());
        radiosity::report(callback, {"probes", fraction, 0, 0.0});
    });
    progress.clear();
    // The first in the file's order, whichever thread was faster.
    for (std::size_t k = 0; k < errors.size(); ++k)
        if (!errors[k].empty())
            throw mesh::InputError(
                fmt::format("{}:{}: {}", options.points, points.rows[k].line, errors[k]));
    if (progress.stopped()) throw mesh::InputError("stopped on request: nothing was written.");
    return table;
}

std::string as_csv(const Table& table) {
    auto text = fmt::format("{}\n", fmt::join(table.columns, ","));
    for (const auto& row : table.rows)
        fmt::format_to(std::back_inserter(text), "{}\n", fmt::join(row, ","));
    return text;
}

int probe(const PointsOptions& options, const CommonFlags& flags) {
    const auto points = parse_points(mesh::read_file(options.points), options.points);
    const auto file = radiosity::read_solution(solution_path(options.solution));
    const auto table = probe_all(file.solution, points, options, flags);
    if (!options.out.empty()) mesh::write_file(options.out, as_csv(table));
    if (flags.json)
        write_output(
            nlohmann::ordered_json{{"columns", table.columns}, {"rows", table.rows}}.dump() + "\n");
    else if (options.out.empty())
        write_output(as_csv(table));
    else if (!flags.quiet)
        write_output(fmt::format("wrote    {} ({} points)\n", options.out, table.rows.size()));
    return 0;
}

}  // namespace

void add_probe_command(Shell& shell) {
    const auto options = std::make_shared<PointsOptions>();
    auto command =
        shell.add_command("probe", "Quantities at points, from the solution file alone",
                          R"(  tyndall probe out/ --points points.csv
  tyndall probe out/ --points walls.csv -o irradiance.csv --rays 65536)",
                          [options](const CommonFlags& flags) { return probe(*options, flags); });
    add_seed_flag(command, shell.flags());
    command.option("OUT", options->solution, "Folder of a run, or a solution file")
        .required()
        .file({"vtkhdf"})
        .folder();
    command
        .option("--points", options->points,
                "CSV with x,y,z (J and G) or x,y,z,nx,ny,nz (irradiance); T where there are "
                "temperatures")
        .required()
        .file({"csv"});
    command.option("-o,--output", options->out, "CSV to write; else standard output").file({"csv"});
    command.option("--rays", options->rays, "Gathered along at each point; 4096 if not given")
        .between(std::size_t(1), std::size_t(1) << 24);
}

}  // namespace tyndall::cli
