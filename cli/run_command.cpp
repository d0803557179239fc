#include <filesystem>

#include "cli/commands.h"
#include "cli/job.h"
#include "cli/passes.h"
#include "cli/preview.h"
#include "cli/report_file.h"
#include "cli/run_report.h"
#include "cli/view_file.h"
#include "mesh/file_bytes.h"
#include "radiosity/resources.h"
#include "radiosity/solution_file.h"
#include "render/image_files.h"

namespace tyndall::cli {
namespace {

namespace fs = std::filesystem;

struct RunOptions {
    std::string scene, out;
    PassChoice passes{};
    PreviewChoice preview{};
    bool no_view = false, no_report = false;
};

enum class Picture { wanted, not_wanted };

// The picture, or why there is none.
std::string write_picture(const SceneFile& file, const radiosity::Solution& solution,
                          const fs::path& folder, ProgressLine& progress, Preview& preview,
                          RunFacts& facts) {
    if (file.cameras.empty()) return "no picture: the scene has no camera.";
    const std::string stopped = "no picture: stopped on request. Make one: tyndall render '" +
                                folder.string() + "' -o image.exr.";
    if (progress.stopped()) return stopped;
    const auto& camera = find_camera(file.cameras, file.view_camera);
    const auto image = make_picture(solution, camera, file.render, progress);
    if (progress.stopped()) return stopped;
    render::write_image(folder / "image.exr", image);
    facts.written.push_back(folder / "image.exr");
    render::write_image(folder / "image.png", render::tone_map(image, file.tone_map));
    facts.written.push_back(folder / "image.png");
    preview.show_last(image);
    return "";
}

// A file of an earlier run that this one did not replace.
void warn_of_old(const fs::path& folder, const std::string& name, radiosity::Report& report) {
    if (fs::exists(folder / name))
        report.warnings.push_back(name + " in '" + folder.string() + "' is of an earlier run.");
}

// What was asked for, without what does not change the results.
std::string command_of(const RunOptions& options, const CommonFlags& flags, Picture picture) {
    std::vector<std::string> words{"tyndall", picture == Picture::wanted ? "run" : "solve",
                                   options.scene, "-o", options.out};
    if (flags.seed) words.insert(words.end(), {"--seed", std::to_string(*flags.seed)});
    for (const auto& setting : override_texts(flags)) words.insert(words.end(), {"--set", setting});
    if (options.passes.resume) words.push_back("--resume");
    if (!options.passes.replay.empty())
        words.insert(words.end(), {"--replay", options.passes.replay});
    return command_line(words);
}

// view.html and report.html, as far as they are wanted.
void write_pages(const fs::path& folder, const RunOptions& options, const SceneFile& file,
                 const radiosity::Solution& solution, const std::string& report, bool pictured,
                 bool viewed, RunFacts& facts) {
    const ViewSettings settings{file.scene.title, file.cameras, file.view_camera, file.render,
                                file.tone_map};
    const auto untitled = fs::path(options.scene).stem().string();
    if (viewed) {
        write_view(folder / "view.html", solution, settings,
                   {report, untitled, file.solve.error, options.no_report ? "" : "report.html"});
        facts.written.push_back(folder / "view.html");
    }
    if (options.no_report) return;
    write_report(folder / "report.html", solution, settings,
                 {report,
                  file.effective_toml,
                  pictured ? folder / "image.png" : fs::path(),
                  viewed ? "view.html" : "",
                  {},
                  untitled});
    facts.written.push_back(folder / "report.html");
}

int run(const RunOptions& options, const CommonFlags& flags, Picture picture) {
    RunFacts facts{options.scene,
                   1,
                   threads_in_use(),
                   radiosity::wall_seconds(),
                   {},
                   {},
                   command_of(options, flags, picture)};
    const SceneFile file = load_scene(options.scene, flags);
    facts.seed = file.solve.seed;
    const fs::path folder(options.out);
    prepare_folder(folder);
    ProgressLine progress(flags);
    auto plan = plan_passes(file, folder, options.passes);
    facts.resumed_from = plan.resumed_from;
    const auto enclosure = mesh_scene(file, progress);
    Preview preview(file, folder, options.preview, progress);
    preview.show_surfaces(*enclosure);
    plan.passes.watch = preview.watch();
    auto solution = solve_scene(file, enclosure, progress, plan.passes);
    const auto solution_file = folder / "solution.vtkhdf";
    radiosity::write_solution(solution_file, solution, attachments_json(file));
    facts.written.push_back(solution_file);
    if (picture == Picture::wanted) {
        const auto missing = write_picture(file, solution, folder, progress, preview, facts);
        if (!missing.empty()) solution.report.warnings.push_back(missing);
    }
    const bool pictured = facts.written.size() > 1;
    const bool viewed = picture == Picture::wanted && !options.no_view && !progress.stopped();
    if (!pictured) warn_of_old(folder, "image.exr", solution.report);
    if (!viewed) warn_of_old(folder, "view.html", solution.report);
    if (options.no_report) warn_of_old(folder, "report.html", solution.report);
    facts.written.push_back(folder / "report.json");
    const auto report = report_text(solution.report, facts);
    mesh::write_file(folder / "report.json", report);
    write_pages(folder, options, file, solution, report, pictured, viewed, facts);
    progress.clear();
    if (flags.json)
        write_output(report);
    else if (!flags.quiet)
        write_output(summary_text(solution.report, facts));
    return 0;
}

void add(Shell& shell, const char* name, const char* purpose, const char* examples,
         Picture picture) {
    const auto options = std::make_shared<RunOptions>();
    auto command = shell.add_command(
        name, purpose, examples,
        [options, picture](const CommonFlags& flags) { return run(*options, flags, picture); });
    add_seed_flag(command, shell.flags());
    add_set_flag(command, shell.flags());
    command.option("SCENE", options->scene, "Scene file").required().file({"toml"});
    command.option("-o,--output", options->out, "Folder for the results").required().folder();
    const auto resume = command.flag("--resume", options->passes.resume,
                                     "Go on from the last finished pass in the folder");
    command
        .option("--replay", options->passes.replay,
                "Take the mesh of this pass (OUT/passes/NN.vtkhdf) or solution as it is")
        .file({"vtkhdf"})
        .excludes(resume);
    command.flag("--no-report", options->no_report, "Write no report.html");
    if (picture == Picture::not_wanted) return;
    command.flag("--no-view", options->no_view, "Write no view.html");
    command.flag("--preview", options->preview.wanted,
                 "A picture in DIR/preview.png as the solution evolves: surfaces at once, the "
                 "medium as soon as it is solved");
    command
        .option("--preview-every", options->preview.every,
                "The same, this many seconds apart at least")
        .not_negative();
    command.flag("--frames", options->preview.frames,
                 "Keep these pictures, DIR/frames/0001.png and so on, for a film");
}

}  // namespace

void add_run_command(Shell& shell) {
    add(shell, "run", "Mesh, solve adaptively, render, report: the main job",
        R"(  tyndall run room.toml -o out/
  tyndall run room.toml -o fine/ --set solve.error=0.01 --set camera.main.width=1280
  tyndall run room.toml -o out/ --preview      look at out/preview.png meanwhile
  tyndall run room.toml -o out/ --resume       go on where a run was stopped)",
        Picture::wanted);
}

void add_solve_command(Shell& shell) {
    add(shell, "solve", "The same without a picture",
        R"(  tyndall solve room.toml -o out/
  tyndall solve room.toml -o out/ --set solve.camera= --json       good everywhere)",
        Picture::not_wanted);
}

}  // namespace tyndall::cli
