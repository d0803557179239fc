#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/job.h"
#include "cli/view_file.h"
#include "mesh/file_bytes.h"
#include "mesh/input_error.h"
#include "radiosity/solution_file.h"

namespace tyndall::cli {
namespace {

namespace fs = std::filesystem;

struct ViewOptions {
    std::string solution, out;
};

// Beside the solution, if nothing else is said.
fs::path page_path(const ViewOptions& options) {
    const fs::path given(options.out);
    if (options.out.empty()) return solution_path(options.solution).parent_path() / "view.html";
    if (given.extension() != ".html" && given.extension() != ".htm")
        throw mesh::InputError(fmt::format(
            "'{}': a browser opens pages by their name. Name an .html file.", options.out));
    return given;
}

// That of the run, which knows what it cost; "": there is none, or it is of another solution.
std::string report_beside(const fs::path& solution, const radiosity::Report& report) {
    const auto path = solution.parent_path() / "report.json";
    std::error_code ignored;
    if (!fs::exists(path, ignored)) return "";
    const std::string text = mesh::read_file(path);
    const auto json = nlohmann::json::parse(text, nullptr, false);
    const bool same = json.is_object() && json.value("patches", 0u) == report.patches &&
                      json.value("zones", 0u) == report.zones &&
                      json.value("estimated_error", -1.0) == report.estimated_error;
    return same ? text : "";
}

int make_view(const ViewOptions& options, const CommonFlags& flags) {
    const auto page = page_path(options);
    const auto path = solution_path(options.solution);
    const auto file = radiosity::read_solution(path);
    const auto scene = attached_scene(file.attachments);
    ViewSettings settings;
    if (!scene.empty()) settings = read_view_settings(scene, override_texts(flags));
    settings.render.threads = flags.threads;
    write_view(page, file.solution, settings, report_beside(path, file.solution.report),
               path.parent_path().filename().string());
    const auto bytes = fs::file_size(page);
    if (flags.json)
        write_output(nlohmann::ordered_json{{"file", page.string()},
                                            {"bytes", bytes},
                                            {"patches", file.solution.report.patches},
                                            {"zones", file.solution.report.zones}}
                         .dump(2) +
                     "\n");
    else if (!flags.quiet)
        write_output(fmt::format("wrote    {} ({:.1f} MB): open it in a browser\n", page.string(),
                                 static_cast<double>(bytes) / 1e6));
    return 0;
}

}  // namespace

void add_view_command(Shell& shell) {
    const auto options = std::make_shared<ViewOptions>();
    auto command = shell.add_command(
        "view", "A page to walk through the solution in a browser",
        R"(  tyndall view out/
  tyndall view out/ -o talk.html --set camera.main.fov_x=60)",
        [options](const CommonFlags& flags) { return make_view(*options, flags); });
    add_set_flag(command, shell.flags());
    command.option("OUT", options->solution, "Folder of a run, or a solution file")
        .required()
        .file({"vtkhdf"})
        .folder();
    command.option("-o,--output", options->out, "Page; else view.html beside the solution")
        .file({"html"});
}

}  // namespace tyndall::cli
