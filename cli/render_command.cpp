#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands.h"
#include "cli/job.h"
#include "mesh/input_error.h"
#include "radiosity/resources.h"
#include "radiosity/solution_file.h"
#include "render/image_files.h"
#include "render/renderers.h"

namespace tyndall::cli {
namespace {

namespace fs = std::filesystem;

struct PictureOptions {
    std::string solution, out, camera, method, layer;
    std::optional<std::size_t> samples;
    std::optional<double> error, time, exposure, white;
};

constexpr const char* examples =
    R"(  tyndall render out/ -o picture.png --exposure 1
  tyndall render out/ --camera side --layer direct_single -o direct.pfm
  tyndall render out/ --method path_traced --error 0.02 -o oracle.exr
  tyndall render out/ -o large.exr --samples 64 --set camera.main.width=1920)";

// What the solution's scene says, then --set, then the flags.
ViewSettings settings_of(const PictureOptions& options, const CommonFlags& flags,
                         const std::string& scene) {
    if (scene.empty())
        throw mesh::InputError(
            fmt::format("'{}' carries no scene, so there is no camera to render with. Make the "
                        "solution by tyndall solve.",
                        options.solution));
    auto settings = read_view_settings(scene, override_texts(flags));
    if (flags.seed) settings.render.seed = *flags.seed;
    if (options.samples) settings.render.samples = *options.samples;
    if (!options.method.empty()) settings.render.method = options.method;
    if (options.error) settings.render.error = *options.error;
    if (options.time) settings.render.time = *options.time;
    if ((options.error || options.time) &&
        !render::renderer_named(settings.render.method).draws_lots)
        throw mesh::InputError(fmt::format(
            "{} has no noise that --{} could be a goal for. Choose another --method, or give "
            "--samples.",
            settings.render.method, options.error ? "error" : "time"));
    if (options.exposure) settings.tone_map.exposure = *options.exposure;
    if (options.white) settings.tone_map.white = *options.white;
    return settings;
}

void write(const fs::path& path, const render::Image& image, const ViewSettings& settings) {
    if (path.extension() == ".png" || path.extension() == ".PNG")
        render::write_image(path, render::tone_map(image, settings.tone_map));
    else
        render::write_image(path, image);
}

// What made the picture, and what it cost.
nlohmann::ordered_json report(const std::string& file, const render::Camera& camera,
                              const ViewSettings& settings, const render::Image& image,
                              double cpu_seconds) {
    nlohmann::ordered_json json{
        {"file", file},
        {"camera", camera.name},
        {"method", settings.render.method},
        {"samples", image.samples > 0 ? image.samples : settings.render.samples},
        {"layer", image.layers[0].name},
        {"width", image.width},
        {"height", image.height},
        {"cpu_seconds", cpu_seconds}};
    if (image.estimated_block4 > 0.0) json["estimated_block4"] = image.estimated_block4;
    return json;
}

std::string summary(const std::string& file, const render::Camera& camera,
                    const render::Image& image) {
    std::string text = fmt::format("wrote    {} ({} x {}, camera \"{}\", {})\n", file, image.width,
                                   image.height, camera.name, image.layers[0].name);
    if (image.estimated_block4 > 0.0)
        text += fmt::format("noise    {:.2g} % in blocks of 4 x 4 pixels, {} rays a pixel\n",
                            100.0 * image.estimated_block4, image.samples);
    return text;
}

int make_and_write(const PictureOptions& options, const CommonFlags& flags) {
    render::check_writable_image(options.out);
    const auto file = radiosity::read_solution(solution_path(options.solution));
    const auto settings = settings_of(options, flags, attached_scene(file.attachments));
    const auto& camera = find_camera(
        settings.cameras, options.camera.empty() ? settings.view_camera : options.camera);
    ProgressLine progress(flags);
    const double cpu = radiosity::cpu_seconds();
    auto image = make_picture(file.solution, camera, settings.render, progress);
    const double spent = radiosity::cpu_seconds() - cpu;
    progress.clear();
    if (progress.stopped()) throw mesh::InputError("stopped on request: no picture was written.");
    if (!options.layer.empty()) image.layers = {render::select_layer(image, options.layer)};
    write(options.out, image, settings);
    if (flags.json)
        write_output(report(options.out, camera, settings, image, spent).dump(2) + "\n");
    else if (!flags.quiet)
        write_output(summary(options.out, camera, image));
    return 0;
}

}  // namespace

void add_render_command(Shell& shell) {
    const auto options = std::make_shared<PictureOptions>();
    auto command = shell.add_command(
        "render", "A picture again, from the solution file alone", examples,
        [options](const CommonFlags& flags) { return make_and_write(*options, flags); });
    add_seed_flag(command, shell.flags());
    add_set_flag(command, shell.flags());
    command.option("OUT", options->solution, "Folder of a run, or a solution file").required();
    command.option("-o,--output", options->out, "Picture: .exr, .pfm or .png").required();
    command.option("--camera", options->camera, "Camera of the scene; else the one solved for");
    command.option("--method", options->method, "Render method; else the scene's");
    command.option("--layer", options->layer,
                   "Write this layer alone; direct_single: emission + surfaces_direct + "
                   "single_scattering");
    command.option("--samples", options->samples, "Rays a pixel")
        .between(std::size_t(1), std::size_t(65536));
    command
        .option("--error", options->error,
                "Goal: estimated error in blocks of 4 x 4 pixels, over the mean (two_pass, "
                "path_traced)")
        .positive();
    command.option("--time", options->time, "Wall time to spend [s] (two_pass, path_traced)")
        .positive();
    command.option("--exposure", options->exposure, "Stops added to a PNG's exposure");
    command.option("--white", options->white, "Radiance shown as white in a PNG [W/m2/sr]")
        .positive();
}

}  // namespace tyndall::cli
