#include <fmt/format.h>

#include <charconv>

#include "cli/animator.h"
#include "cli/commands.h"
#include "cli/job.h"
#include "cli/study_run.h"
#include "mesh/input_error.h"
#include "radiosity/resources.h"

namespace tyndall::cli {
namespace {

namespace fs = std::filesystem;
using mesh::InputError;

struct AnimateOptions {
    std::string scene, out, frames;
    bool resume = false;
};

constexpr const char* animate_examples =
    R"(  tyndall animate examples/scenes/sunset.toml -o sunset/
  tyndall animate sunset.toml -o sunset/ --frames 12:23 --resume
  ffmpeg -framerate 24 -i sunset/frames/%04d.png -pix_fmt yuv420p sunset.mp4)";

struct Part {
    std::size_t first = 0, last = 0;
};

// "A:B", "A:", ":B" or "A": both ends are made.
Part part_of(const std::string& text, std::size_t frames) {
    Part part{0, frames - 1};
    if (text.empty()) return part;
    const auto colon = text.find(':');
    const auto read = [&](const std::string& number, std::size_t& to) {
        if (number.empty() && colon != text.npos) return true;
        const char* end = number.data() + number.size();
        const auto result = std::from_chars(number.data(), end, to);
        return result.ec == std::errc() && result.ptr == end;
    };
    const bool good = read(text.substr(0, colon), part.first) &&
                      read(colon == text.npos ? text : text.substr(colon + 1), part.last);
    if (!good || part.first > part.last || part.last >= frames)
        throw InputError(fmt::format(
            "--frames {}: the animation has the frames 0 to {}. Give the first and the last one to "
            "make, as in --frames 0:{}.",
            text, frames - 1, frames - 1));
    return part;
}

std::string summary(const AnimationRecord& record, const Part& part, std::size_t kept, bool stopped,
                    const RunFacts& facts) {
    std::string text = fmt::format("frames   {} to {}", part.first, part.last);
    if (kept > 0) text += fmt::format(", {} of them from before", kept);
    text += fmt::format("; {} in the folder\n", record.size());
    text += fmt::format("cost     {:.1f} s, {:.1f} CPU s, {:.0f} MB\n",
                        radiosity::wall_seconds() - facts.began, radiosity::cpu_seconds(),
                        static_cast<double>(radiosity::peak_memory_bytes()) / 1e6);
    if (stopped) text += "warning  stopped on request. Go on by the same command with --resume.\n";
    for (const auto& path : facts.written) text += "wrote    " + path.string() + "\n";
    return text;
}

int animate(const AnimateOptions& options, const CommonFlags& flags) {
    RunFacts facts{options.scene, 1, threads_in_use(), radiosity::wall_seconds(), {}, {}};
    const SceneFile file = load_scene(options.scene, flags);
    if (!file.animation)
        throw InputError(
            fmt::format("{}: the scene has no [animation]. Add one, with frames = 48 and an "
                        "[[animation.track]] for each key that changes.",
                        options.scene));
    facts.seed = file.solve.seed;
    const std::size_t count = file.animation->frames;
    const Part part = part_of(options.frames, count);
    const auto frames = read_frames(options.scene, scene_overrides(flags), file);
    const fs::path folder(options.out);
    for (const char* inner : {"", "frames", "solutions"}) prepare_folder(folder / inner);
    AnimationRecord record(folder, run_key(options.scene, file), file.animation->fps);
    ProgressLine progress(flags);
    Animator animator(frames, record, progress);
    std::size_t kept = 0;
    for (std::size_t frame = part.first; frame <= part.last && !progress.stopped(); ++frame) {
        if (options.resume && record.has(frame)) {
            ++kept;
            continue;
        }
        record.forget(frame);
        if (animator.make(frame)) record.write(facts, count);
    }
    progress.clear();
    record.write(facts, count);
    facts.written = {folder / "frames", folder / "solutions.vtkhdf.series", folder / "report.json"};
    if (flags.json)
        write_output(record.text(facts, count));
    else if (!flags.quiet)
        write_output(summary(record, part, kept, progress.stopped(), facts));
    return 0;
}

}  // namespace

void add_animate_command(Shell& shell) {
    const auto options = std::make_shared<AnimateOptions>();
    auto command = shell.add_command(
        "animate", "The frames of a scene whose keys change in time", animate_examples,
        [options](const CommonFlags& flags) { return animate(*options, flags); });
    add_seed_flag(command, shell.flags());
    add_set_flag(command, shell.flags());
    command.option("SCENE", options->scene, "Scene file with an [animation]")
        .required()
        .file({"toml"});
    command.option("-o,--output", options->out, "Folder for the results").required().folder();
    command.option("--frames", options->frames, "A part: the first and the last frame, as in 0:23");
    command.flag(
        "--resume", options->resume,
        "Keep the frames in the folder that are whole, if scene and settings are the same");
}

}  // namespace tyndall::cli
