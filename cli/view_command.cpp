#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/job.h"
#include "cli/report_file.h"
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

// Cameras that --set has changed: the mesh was refined for others.
std::vector<std::string> camera_notes(const ViewSettings& solved, const ViewSettings& shown) {
    std::vector<std::string> notes;
    for (std::size_t k = 0; k < solved.cameras.size() && k < shown.cameras.size(); ++k)
        if (solved.cameras[k].name == solved.view_camera && solved.cameras[k] != shown.cameras[k])
            notes.push_back(fmt::format(
                "Camera \"{}\" has been changed since the mesh was refined for it: what it sees "
                "now may be coarser than the estimated error of the picture says. Solve again, or "
                "with solve.camera = \"\" for a mesh that is good from everywhere.",
                solved.view_camera));
    return notes;
}

// The picture beside the solution, if it is of the same run.
fs::path picture_beside(const fs::path& solution, const std::string& report) {
    const auto path = solution.parent_path() / "image.png";
    std::error_code ignored;
    const bool old = report.empty() || report.find("image.exr in ") != std::string::npos;
    return old || !fs::exists(path, ignored) ? fs::path() : path;
}

struct Made {
    fs::path page, report;  // empty: not made
};

// view.html and, beside it, report.html; a page of another name stands for itself.
Made write_pages(const ViewOptions& options, const CommonFlags& flags,
                 const radiosity::SolutionFile& file) {
    const auto path = solution_path(options.solution);
    const auto scene = attached_scene(file.attachments);
    ViewSettings settings;
    std::vector<std::string> notes;
    if (!scene.empty()) {
        settings = read_view_settings(scene, override_texts(flags));
        notes = camera_notes(read_view_settings(scene, {}), settings);
    }
    settings.render.threads = flags.threads;
    const auto report = report_beside(path, file.solution.report);
    const auto untitled = path.parent_path().filename().string();
    Made made{page_path(options), {}};
    if (options.out.empty()) made.report = path.parent_path() / "report.html";
    write_view(made.page, file.solution, settings,
               {report, untitled, scene.empty() ? 0.0 : reported_scene(scene).goal,
                made.report.filename().string()});
    if (!made.report.empty())
        write_report(made.report, file.solution, settings,
                     {report, scene, picture_beside(path, report), made.page.filename().string(),
                      notes, untitled});
    return made;
}

int make_view(const ViewOptions& options, const CommonFlags& flags) {
    page_path(options);  // refused before long work
    const auto file = radiosity::read_solution(solution_path(options.solution));
    const Made made = write_pages(options, flags, file);
    const auto bytes = fs::file_size(made.page);
    nlohmann::ordered_json json{{"file", made.page.string()},
                                {"bytes", bytes},
                                {"patches", file.solution.report.patches},
                                {"zones", file.solution.report.zones}};
    if (!made.report.empty()) json["report"] = made.report.string();
    if (flags.json)
        write_output(json.dump(2) + "\n");
    else if (!flags.quiet)
        write_output(fmt::format(
            "wrote    {} ({:.1f} MB): open it in a browser\n{}", made.page.string(),
            static_cast<double>(bytes) / 1e6,
            made.report.empty() ? "" : fmt::format("wrote    {}\n", made.report.string())));
    return 0;
}

}  // namespace

void add_view_command(Shell& shell) {
    const auto options = std::make_shared<ViewOptions>();
    auto command = shell.add_command(
        "view", "Pages of a solution: to walk through it in a browser, and its report",
        R"(  tyndall view out/
  tyndall view out/ -o talk.html --set camera.main.fov_x=60)",
        [options](const CommonFlags& flags) { return make_view(*options, flags); });
    add_set_flag(command, shell.flags());
    command.option("OUT", options->solution, "Folder of a run, or a solution file")
        .required()
        .file({"vtkhdf"})
        .folder();
    command
        .option("-o,--output", options->out,
                "Page to walk through alone; else view.html and report.html beside the solution")
        .file({"html"});
}

}  // namespace tyndall::cli
