#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/export_source.h"
#include "exports/coloured_surfaces.h"
#include "exports/gmsh_file.h"
#include "exports/mitsuba_scene.h"
#include "exports/pbrt_scene.h"
#include "exports/vtu_file.h"
#include "mesh/file_bytes.h"
#include "mesh/input_error.h"
#include "radiosity/linear_pieces.h"

namespace tyndall::cli {
namespace {

namespace fs = std::filesystem;
using mesh::InputError;

struct ExportOptions {
    std::string from, out, format, camera;
    std::optional<std::size_t> band, samples;
};

// A format: how files of it are called, and who makes them.
struct Format {
    std::string name, extension;
    bool path_traced;  // takes --camera, --band and --samples
    exports::ExportedFiles (*make)(const ExportSource&, const ExportOptions&);
};

// The one that is named, or all, the one solved for first.
std::vector<render::Camera> cameras_of(const ExportSource& source, const ExportOptions& options) {
    auto cameras = source.settings.cameras;
    if (!options.camera.empty()) return {find_camera(cameras, options.camera)};
    std::stable_partition(cameras.begin(), cameras.end(), [&](const render::Camera& camera) {
        return camera.name == source.settings.view_camera;
    });
    return cameras;
}

exports::PathTracerOptions path_tracer_options(const ExportSource& source,
                                               const ExportOptions& options) {
    exports::PathTracerOptions result;
    result.title = source.settings.title;
    result.stem = fs::path(options.out).stem().string();
    if (options.samples) result.samples = *options.samples;
    result.band = options.band;
    return result;
}

// Of formats that hold what elements hold.
const radiosity::Solution& solved(const ExportSource& source, const ExportOptions& options) {
    if (!source.solution)
        throw InputError(
            fmt::format("'{}' is a scene, and '{}' is to show its solution. Give the folder of a "
                        "run: tyndall run {} -o out/.",
                        options.from, options.out, options.from));
    return *source.solution;
}

// Of a quadratic solution linear pieces, as many as a linear one has to show the same light.
template <class Write>
exports::ExportedFiles in_pieces(const radiosity::Solution& solution, Write&& write) {
    return radiosity::is_quadratic(solution) ? write(radiosity::linear_pieces(solution))
                                             : write(solution);
}

exports::ExportedFiles make_vtu(const ExportSource& source, const ExportOptions& options) {
    return exports::vtu_file(solved(source, options));
}

exports::ExportedFiles make_gmsh(const ExportSource& source, const ExportOptions&) {
    return exports::gmsh_file(*source.enclosure);
}

exports::ExportedFiles make_obj(const ExportSource& source, const ExportOptions& options) {
    return in_pieces(solved(source, options), [&](const radiosity::Solution& solution) {
        return exports::coloured_obj(solution, fs::path(options.out).stem().string(),
                                     source.settings.tone_map);
    });
}

exports::ExportedFiles make_ply(const ExportSource& source, const ExportOptions& options) {
    return in_pieces(solved(source, options), [&](const radiosity::Solution& solution) {
        return exports::coloured_ply(solution, source.settings.tone_map);
    });
}

exports::ExportedFiles make_mitsuba(const ExportSource& source, const ExportOptions& options) {
    return exports::mitsuba_scene(*source.enclosure, cameras_of(source, options),
                                  path_tracer_options(source, options));
}

exports::ExportedFiles make_pbrt(const ExportSource& source, const ExportOptions& options) {
    return exports::pbrt_scene(*source.enclosure, cameras_of(source, options),
                               path_tracer_options(source, options));
}

const std::vector<Format>& formats() {
    static const std::vector<Format> all{
        {"vtu", ".vtu", false, make_vtu},        {"gmsh", ".msh", false, make_gmsh},
        {"obj", ".obj", false, make_obj},        {"ply", ".ply", false, make_ply},
        {"mitsuba", ".xml", true, make_mitsuba}, {"pbrt", ".pbrt", true, make_pbrt}};
    return all;
}

const Format& format_of(const ExportOptions& options) {
    const std::string extension = fs::path(options.out).extension().string();
    for (const Format& format : formats())
        if (options.format.empty() ? format.extension == extension : format.name == options.format)
            return format;
    std::vector<std::string> known;
    for (const Format& format : formats())
        known.push_back(options.format.empty()
                            ? fmt::format("{} ({})", format.extension, format.name)
                            : format.name);
    if (options.format.empty())
        throw InputError(
            fmt::format("'{}': no format writes files of this name. Name one that ends with {}; or "
                        "say which it is by --format.",
                        options.out, fmt::join(known, ", ")));
    throw InputError(fmt::format("there is no format \"{}\". There is: {}.", options.format,
                                 fmt::join(known, ", ")));
}

// The files, parts first: a main file never names what is not there.
std::size_t write(const fs::path& main, const exports::ExportedFiles& files) {
    std::size_t bytes = files.main.size();
    for (const auto& file : files.beside) {
        const fs::path path = main.parent_path() / file.name;
        if (path.has_parent_path()) prepare_folder(path.parent_path());
        mesh::write_file(path, file.bytes);
        bytes += file.bytes.size();
    }
    mesh::write_file(main, files.main);
    return bytes;
}

int export_files(const ExportOptions& options, const CommonFlags& flags) {
    const Format& format = format_of(options);
    const bool chosen = !options.camera.empty() || options.band || options.samples;
    if (chosen && !format.path_traced)
        throw InputError(
            fmt::format("--camera, --band and --samples are of mitsuba and pbrt; a file of format "
                        "{} has no use for them. Leave them out.",
                        format.name));
    const auto source = export_source(options.from, flags);
    const auto files = format.make(source, options);
    const auto bytes = write(options.out, files);
    if (flags.json)
        write_output(nlohmann::ordered_json{{"file", options.out},
                                            {"format", format.name},
                                            {"files", files.beside.size() + 1},
                                            {"bytes", bytes},
                                            {"notes", files.notes}}
                         .dump(2) +
                     "\n");
    else if (!flags.quiet) {
        std::string text = fmt::format("wrote    {} ({}, {:.1f} MB", options.out, format.name,
                                       static_cast<double>(bytes) / 1e6);
        if (!files.beside.empty()) text += fmt::format(" with {} parts", files.beside.size());
        text += ")\n";
        for (const auto& note : files.notes) text += fmt::format("note     {}\n", note);
        write_output(text);
    }
    return 0;
}

}  // namespace

void add_export_command(Shell& shell) {
    const auto options = std::make_shared<ExportOptions>();
    auto command = shell.add_command(
        "export", "The solution or the room as a file for another program",
        R"(  tyndall export out/ -o out/room.vtu
  tyndall export out/ -o room.ply --set render.exposure=1
  tyndall export room.toml -o room.msh
  tyndall export room.toml -o room.xml --samples 1024
  tyndall export out/ -o room.pbrt --camera main)",
        [options](const CommonFlags& flags) { return export_files(*options, flags); });
    add_set_flag(command, shell.flags());
    command
        .option("FROM", options->from,
                "Folder of a run or a solution file; for mitsuba, pbrt, gmsh a scene file, too")
        .required();
    command.option("-o,--output", options->out, "File to write").required();
    command.option("--format", options->format,
                   "What to write, where the file's name does not say it");
    command.option("--camera", options->camera, "This camera alone (mitsuba, pbrt)");
    command.option("--band", options->band, "This band alone, from 0 (mitsuba, pbrt)");
    command.option("--samples", options->samples, "Paths a pixel (mitsuba, pbrt); else 256")
        .positive();
}

}  // namespace tyndall::cli
