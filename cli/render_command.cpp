#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands.h"
#include "cli/job.h"
#include "cli/number_list.h"
#include "mesh/input_error.h"
#include "radiosity/resources.h"
#include "radiosity/solution_file.h"
#include "render/element_fields.h"
#include "render/image_files.h"
#include "render/mesh_pictures.h"
#include "render/renderers.h"

namespace tyndall::cli {
namespace {

namespace fs = std::filesystem;

struct PictureOptions {
    std::string solution, out, camera, method, layer, crop, tone, field, slice, range;
    bool mesh = false;
    std::optional<std::size_t> samples;
    std::optional<double> error, time, exposure, white;
};

constexpr const char* render_examples =
    R"(  tyndall render out/ -o picture.png --exposure 1
  tyndall render out/ --camera main --layer direct_single -o direct.pfm
  tyndall render out/ --method path_traced --error 0.02 -o oracle.exr
  tyndall render out/ --crop 100,40,64,48 --samples 256 -o detail.png
  tyndall render out/ --mesh -o mesh.png
  tyndall render out/ --field error --slice 2.5,0,0,1,0,0 -o errors.png
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
    if (!options.tone.empty()) settings.tone_map.curve = render::tone_curve_named(options.tone);
    return settings;
}

bool is_png(const fs::path& path) {
    return path.extension() == ".png" || path.extension() == ".PNG";
}

void write(const fs::path& path, const render::Image& image, const ViewSettings& settings) {
    if (is_png(path))
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

// The camera that is named, or the one solved for, or a part of its picture.
render::Camera camera_of(const PictureOptions& options, const ViewSettings& settings) {
    const auto& camera = find_camera(
        settings.cameras, options.camera.empty() ? settings.view_camera : options.camera);
    if (options.crop.empty()) return camera;
    const auto n = count_list(options.crop, 4, "--crop", "left,top,width,height in pixels");
    return camera.cropped(n[0], n[1], n[2], n[3]);
}

// What to know of a picture by another camera than that whose picture the mesh was refined for.
std::string view_warning(const ViewSettings& settings, const render::Camera& camera) {
    if (settings.view_camera.empty() || settings.view_camera == camera.name) return "";
    return fmt::format(
        "the solution was refined for camera \"{}\": what only \"{}\" sees may be "
        "coarse. Solve with --set solve.camera={}.",
        settings.view_camera, camera.name, camera.name);
}

// Elements in colours, or their edges over the picture.
int draw_mesh(const PictureOptions& options, const CommonFlags& flags,
              const radiosity::Solution& solution, const ViewSettings& settings) {
    if (!is_png(options.out))
        throw mesh::InputError(fmt::format(
            "'{}': elements are drawn in colours of the screen. Name a .png file.", options.out));
    render::FieldOptions field;
    if (!options.field.empty()) field.field = options.field;
    if (!options.range.empty()) {
        const auto ends = number_list(options.range, 2, "--range", "low,high");
        field.low = ends[0];
        field.high = ends[1];
    }
    render::FieldPicture picture;
    if (!options.slice.empty()) {
        auto plane = render::default_plane(*solution.enclosure);
        if (options.slice != "middle") {
            const auto n = number_list(options.slice, 6, "--slice",
                                       "x,y,z of a point and of the normal, or middle");
            plane = {{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
            if (plane.normal == mesh::Direction(0.0))
                throw mesh::InputError("--slice: a plane of normal 0,0,0 is none. Give another.");
        }
        picture = render::field_slice(solution, plane, field);
    } else {
        field.edges = options.mesh;
        picture = render::field_picture(solution, camera_of(options, settings), field);
    }
    render::write_image(options.out, picture.image);
    const auto& named = render::field_named(field.field);
    if (flags.json)
        write_output(nlohmann::ordered_json{{"file", options.out},
                                            {"field", named.name},
                                            {"unit", named.unit},
                                            {"low", picture.scale.low},
                                            {"high", picture.scale.high},
                                            {"logarithmic", picture.scale.logarithmic},
                                            {"width", picture.image.width},
                                            {"height", picture.image.height}}
                         .dump(2) +
                     "\n");
    else if (!flags.quiet)
        write_output(
            fmt::format("wrote    {} ({} from {:.4g}, dark blue, to {:.4g} {}, yellow{})\n",
                        options.out, named.name, picture.scale.low, picture.scale.high, named.unit,
                        picture.scale.logarithmic ? "; logarithmic" : ""));
    return 0;
}

int make_and_write(const PictureOptions& options, const CommonFlags& flags) {
    render::check_writable_image(options.out);
    const auto file = radiosity::read_solution(solution_path(options.solution));
    const auto settings = settings_of(options, flags, attached_scene(file.attachments));
    if (!options.field.empty() || !options.slice.empty())
        return draw_mesh(options, flags, file.solution, settings);
    if (options.mesh && !is_png(options.out))
        throw mesh::InputError(fmt::format(
            "'{}': edges are drawn over a picture for the screen. Name a .png file.", options.out));
    const auto camera = camera_of(options, settings);
    const auto warning = view_warning(settings, camera);
    ProgressLine progress(flags);
    const double cpu = radiosity::cpu_seconds();
    auto image = make_picture(file.solution, camera, settings.render, progress);
    const double spent = radiosity::cpu_seconds() - cpu;
    progress.clear();
    if (progress.stopped()) throw mesh::InputError("stopped on request: no picture was written.");
    if (!options.layer.empty()) image.layers = {render::select_layer(image, options.layer)};
    if (options.mesh)
        render::write_image(options.out,
                            render::mesh_overlay(file.solution, camera,
                                                 render::tone_map(image, settings.tone_map)));
    else
        write(options.out, image, settings);
    auto json = report(options.out, camera, settings, image, spent);
    if (!warning.empty()) json["warnings"] = {warning};
    if (flags.json)
        write_output(json.dump(2) + "\n");
    else if (!flags.quiet)
        write_output(summary(options.out, camera, image) +
                     (warning.empty() ? "" : "warning  " + warning + "\n"));
    return 0;
}

}  // namespace

void add_render_command(Shell& shell) {
    const auto options = std::make_shared<PictureOptions>();
    auto command = shell.add_command(
        "render", "A picture again, from the solution file alone", render_examples,
        [options](const CommonFlags& flags) { return make_and_write(*options, flags); });
    add_seed_flag(command, shell.flags());
    add_set_flag(command, shell.flags());
    command.option("OUT", options->solution, "Folder of a run, or a solution file")
        .required()
        .file({"vtkhdf"})
        .folder();
    command.option("-o,--output", options->out, "Picture: .exr, .pfm or .png")
        .required()
        .file({"exr", "pfm", "png"});
    command.option("--camera", options->camera, "Camera of the scene; else the one solved for");
    command.option("--method", options->method, "Render method; else the scene's")
        .name_of(render::renderer_names());
    command.option("--layer", options->layer,
                   "Write this layer alone; direct_single: emission + surfaces_direct + "
                   "single_scattering");
    command.option("--samples", options->samples, "Rays a pixel")
        .between(std::size_t(1), std::size_t(65536));
    command
        .option("--error", options->error,
                "Goal: estimated error in blocks of 4 x 4 pixels, over the mean "
                "(last_scatter, two_pass, path_traced)")
        .positive();
    command.option("--time", options->time, "Wall time to spend [s] (likewise)").positive();
    command.option("--crop", options->crop, "These pixels of the picture: left,top,width,height");
    command.flag("--mesh", options->mesh, "Draw the edges of the elements that are seen");
    command
        .option("--field", options->field,
                fmt::format("What elements hold, in colours: {}",
                            fmt::join(render::field_names(), ", ")))
        .name_of(render::field_names());
    command.option("--slice", options->slice,
                   "Of the zones on a plane: x,y,z of a point and of the normal, or middle");
    command.option("--range", options->range, "Ends of the colours: low,high; else by the picture");
    command
        .option("--tone", options->tone,
                fmt::format("Curve of a PNG: {}; else the scene's",
                            fmt::join(render::tone_curve_names(), ", ")))
        .name_of(render::tone_curve_names());
    command.option("--exposure", options->exposure, "Stops added to a PNG's exposure");
    command.option("--white", options->white, "Radiance shown as white in a PNG [W/m2/sr]")
        .positive();
}

}  // namespace tyndall::cli
