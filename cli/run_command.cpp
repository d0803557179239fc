#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "cli/commands.h"
#include "cli/progress.h"
#include "cli/scene_file.h"
#include "radiosity/adaptive.h"
#include "radiosity/resources.h"
#include "render/image_files.h"
#include "render/line_of_sight.h"

namespace tyndall::cli {
namespace {
namespace fs = std::filesystem;

struct RunOptions {
    std::string scene, out;
};

int run(const RunOptions& options, const CommonFlags& flags) {
    std::vector<std::string> overrides;
    for (const auto& s : flags.settings) overrides.push_back(s.key + "=" + s.value);
    SceneFile file = read_scene_file(options.scene, overrides);
    if (flags.seed) file.solve.seed = file.render.seed = *flags.seed;
    tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                flags.threads ? flags.threads : tbb::info::default_concurrency());
    ProgressLine progress(flags);
    auto enclosure =
        std::make_shared<const radiosity::Enclosure>(radiosity::make_enclosure(file.scene));
    std::optional<radiosity::View> view;
    for (const auto& camera : file.cameras)
        if (camera.name == file.view_camera) view = camera.view();
    const auto solution =
        radiosity::solve_adaptively(enclosure, file.solve, view, progress.callback());
    fs::create_directories(options.out);
    progress.clear();
    for (const auto& pass : solution.report.passes)
        fmt::print(
            "{:20} {:7} patches {:7} zones {:9} rays {:6.2f} cpu-s {:6.2f} s {:6.1f} MB error "
            "{:.5f}\n",
            pass.stage, pass.patches, pass.zones, pass.rays, pass.cpu_seconds, pass.wall_seconds,
            pass.memory_bytes / 1e6, pass.estimated_error);
    if (!file.cameras.empty()) {
        const auto image =
            render::line_of_sight(solution, file.cameras.front(), file.render, progress.callback());
        render::write_image(fs::path(options.out) / "image.exr", image);
        render::write_image(fs::path(options.out) / "image.png",
                            render::tone_map(image, file.tone_map));
    }
    fmt::print("cpu {:.2f} s, peak {:.0f} MB\n", radiosity::cpu_seconds(),
               radiosity::peak_memory_bytes() / 1e6);
    return 0;
}
}  // namespace

void add_run_command(Shell& shell) {
    auto options = std::make_shared<RunOptions>();
    auto& command =
        shell.add_command("run", "Solve a scene and render it: the main job",
                          "  tyndall run examples/scenes/window_shafts.toml -o out/window_shafts",
                          [options](const CommonFlags& flags) { return run(*options, flags); });
    add_seed_flag(command, shell.flags());
    add_set_flag(command, shell.flags());
    command.add_option("scene", options->scene, "scene file")->required();
    command.add_option("-o,--output", options->out, "folder for the results")->required();
}
}  // namespace tyndall::cli
