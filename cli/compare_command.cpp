#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands.h"
#include "cli/compare_solutions.h"
#include "cli/job.h"
#include "cli/number_list.h"
#include "mesh/input_error.h"
#include "radiosity/solution_file.h"
#include "render/compare.h"
#include "render/image_files.h"

namespace tyndall::cli {

namespace {

namespace fs = std::filesystem;
using mesh::InputError;

struct CompareOptions {
    std::string picture, reference, layer, difference, region;
    bool solutions = false;
    SolutionComparison comparison;
    std::optional<double> difference_range;
    std::optional<double> max_rmse, max_bias, max_block4, max_block16;
};

struct ComparedPicture {
    fs::path path;
    std::size_t width = 0, height = 0;
    render::Layer layer;
};

constexpr const char* compare_examples =
    R"(  tyndall compare out/ reference.pfm
  tyndall compare out/image.exr direct.pfm --layer direct_single --difference off.png
  tyndall compare out/ reference.pfm --region 40,0,64,48
  tyndall compare out/ before/ --max-block4 0.01 || echo worse
  tyndall compare out/ fine/ --solutions)";

// The picture of a folder that `tyndall run` filled, or the file itself.
fs::path picture_file(const std::string& given) {
    fs::path path(given);
    std::error_code ignored;
    if (!fs::is_directory(path, ignored)) return path;
    const auto picture = path / "image.exr";
    if (!fs::exists(picture, ignored))
        throw InputError(
            fmt::format("the folder '{}' holds no image.exr. Make one: tyndall render "
                        "'{}' -o '{}'.",
                        given, given, picture.string()));
    return picture;
}

ComparedPicture load(const std::string& given, const std::string& layer) {
    const auto path = picture_file(given);
    const auto image = render::read_image(path);
    // A PFM file holds one layer without a name: it is taken for the one that is asked for.
    const bool nameless = image.layers.size() == 1 && path.extension() != ".exr";
    try {
        return {path, image.width, image.height, select_layer(image, nameless ? "" : layer)};
    } catch (const InputError& error) {
        throw InputError(fmt::format("'{}': {}", path.string(), error.what()));
    }
}

// What of it is to be compared: "left,top,width,height" in pixels.
void cut(ComparedPicture& side, const std::string& text) {
    const auto n = count_list(text, 4, "--region", "left,top,width,height in pixels");
    const render::Region region{n[0], n[1], n[2], n[3]};
    side.layer = render::region_of(side.width, side.height, side.layer, region);
    side.width = region.width;
    side.height = region.height;
}

nlohmann::ordered_json as_json(const ComparedPicture& picture, const ComparedPicture& reference,
                               const render::PictureError& error) {
    return {{"picture", picture.path.string()},
            {"reference", reference.path.string()},
            {"layer", picture.layer.name},
            {"width", picture.width},
            {"height", picture.height},
            {"channels", picture.layer.channels},
            {"mean", error.mean},
            {"reference_mean", error.reference_mean},
            {"rmse", error.rmse},
            {"bias", error.bias},
            {"mape", error.mape},
            {"block4", error.block4},
            {"block16", error.block16},
            {"max_error", error.max_error},
            {"max_error_pixel", {error.max_x, error.max_y}},
            {"not_finite", error.not_finite},
            {"negative", error.negative}};
}

std::string as_text(const ComparedPicture& picture, const ComparedPicture& reference,
                    const render::PictureError& error) {
    auto text =
        fmt::format("picture       {}, layer {}, {} x {}, {} channel{}\n", picture.path.string(),
                    picture.layer.name, picture.width, picture.height, picture.layer.channels,
                    picture.layer.channels == 1 ? "" : "s");
    text += fmt::format("reference     {}\n", reference.path.string());
    text += fmt::format("mean          {:.6g}, of the reference {:.6g}\n", error.mean,
                        error.reference_mean);
    text += fmt::format("bias          {:+.4f} %\n", 100.0 * error.bias);
    text += fmt::format("RMSE          {:.4f} %\n", 100.0 * error.rmse);
    text += fmt::format("MAPE          {:.4f} %\n", 100.0 * error.mape);
    text += fmt::format("4x4 blocks    {:.4f} %\n", 100.0 * error.block4);
    text += fmt::format("16x16 blocks  {:.4f} %\n", 100.0 * error.block16);
    text += fmt::format("largest       {:.4f} % at pixel ({}, {})\n", 100.0 * error.max_error,
                        error.max_x, error.max_y);
    text += "Errors are relative to the reference's mean, MAPE to its values.\n";
    if (error.negative > 0) text += fmt::format("{} values are negative.\n", error.negative);
    return text;
}

// What is wrong with the picture; empty if nothing.
std::string verdict(const CompareOptions& options, const render::PictureError& error) {
    std::string text;
    const auto add = [&](const std::string& reason) {
        text += (text.empty() ? "" : "; ") + reason;
    };
    const auto check = [&](const char* name, double value, const std::optional<double>& limit) {
        if (limit && !(std::abs(value) <= *limit))
            add(fmt::format("{} {:.6g} exceeds {:.6g}", name, value, *limit));
    };
    if (error.not_finite > 0) add(fmt::format("{} values are not finite", error.not_finite));
    check("rmse", error.rmse, options.max_rmse);
    check("bias", error.bias, options.max_bias);
    check("block4", error.block4, options.max_block4);
    check("block16", error.block16, options.max_block16);
    return text;
}

void write_difference(const CompareOptions& options, const ComparedPicture& picture,
                      const ComparedPicture& reference) {
    const double range = options.difference_range
                             ? *options.difference_range
                             : render::difference_range(picture.layer, reference.layer);
    render::write_image(options.difference,
                        render::difference_picture(picture.width, picture.height, picture.layer,
                                                   reference.layer, range));
}

int compare_pictures(const CompareOptions& options, const CommonFlags& flags) {
    auto picture = load(options.picture, options.layer);
    auto reference = load(options.reference, options.layer);
    if (picture.width != reference.width || picture.height != reference.height)
        throw InputError(
            fmt::format("'{}' has {} × {} pixels and '{}' has {} × {}. Render them in "
                        "the same size.",
                        picture.path.string(), picture.width, picture.height,
                        reference.path.string(), reference.width, reference.height));
    if (!options.region.empty()) {
        cut(picture, options.region);
        cut(reference, options.region);
    }
    const auto error =
        render::compare(picture.width, picture.height, picture.layer, reference.layer);
    if (!options.difference.empty()) write_difference(options, picture, reference);
    if (flags.json)
        write_output(as_json(picture, reference, error).dump(2) + "\n");
    else if (!flags.quiet)
        write_output(as_text(picture, reference, error));
    const auto wrong = verdict(options, error);
    if (!wrong.empty()) throw InputError(fmt::format("'{}': {}.", picture.path.string(), wrong));
    return 0;
}

// Whether solutions are meant: asked for, or there is no picture to compare.
bool wants_solutions(const CompareOptions& options) {
    const auto is_solution = [](const std::string& given) {
        const fs::path path(given);
        std::error_code ignored;
        if (!fs::is_directory(path, ignored)) return path.extension() == ".vtkhdf";
        return !fs::exists(path / "image.exr", ignored) &&
               fs::exists(path / "solution.vtkhdf", ignored);
    };
    return options.solutions || is_solution(options.picture) || is_solution(options.reference);
}

nlohmann::ordered_json as_json(const std::optional<PointErrors>& e) {
    if (!e) return nullptr;
    return {{"points", e->points},
            {"mean", e->mean},
            {"reference_mean", e->reference_mean},
            {"rmse", e->rmse},
            {"bias", e->bias}};
}

std::string as_text(const SolutionErrors& errors) {
    std::string text;
    const auto add = [&](const char* name, const std::optional<PointErrors>& e, const char* unit) {
        if (!e) return;
        text += fmt::format("{}RMSE {:.4f} %, bias {:+.4f} %, mean {:.6g} of {:.6g} {}\n", name,
                            100.0 * e->rmse, 100.0 * e->bias, e->mean, e->reference_mean, unit);
    };
    add("J probed      ", errors.source, "W/m2/sr");
    add("J held        ", errors.source_held, "W/m2/sr");
    add("E probed      ", errors.irradiance, "W/m2");
    add("E held        ", errors.irradiance_held, "W/m2");
    return text +
           "Errors are relative to the reference's mean, at points by 4 kappa volume and by "
           "area.\nHeld: what the leaves hold, against the reference's probes.\n";
}

// What is wrong with the solution; empty if nothing.
std::string verdict(const CompareOptions& options, const SolutionErrors& errors) {
    std::string text;
    const auto check = [&](const char* name, double value, const std::optional<double>& limit) {
        if (limit && !(std::abs(value) <= *limit))
            text += fmt::format("{}{} {:.6g} exceeds {:.6g}", text.empty() ? "" : "; ", name, value,
                                *limit);
    };
    const auto check_both = [&](const char* name, const std::optional<PointErrors>& e) {
        if (!e) return;
        check(fmt::format("rmse of {}", name).c_str(), e->rmse, options.max_rmse);
        check(fmt::format("bias of {}", name).c_str(), e->bias, options.max_bias);
    };
    check_both("J", errors.source);
    check_both("E", errors.irradiance);
    return text;
}

int compare_solution_files(const CompareOptions& options, const CommonFlags& flags) {
    if (!options.layer.empty() || !options.difference.empty() || !options.region.empty() ||
        options.max_block4 || options.max_block16)
        throw InputError(
            "--layer, --region, --difference and block errors speak of pictures, and solutions are "
            "to be "
            "compared. Leave them out, or give pictures.");
    const auto path = solution_path(options.picture), reference = solution_path(options.reference);
    const auto file = radiosity::read_solution(path);
    const auto reference_file = radiosity::read_solution(reference);
    ProgressLine progress(flags);
    const auto errors = compare_solutions(file.solution, reference_file.solution,
                                          options.comparison, progress.callback());
    progress.clear();
    if (flags.json)
        write_output(nlohmann::ordered_json{{"solution", path.string()},
                                            {"reference", reference.string()},
                                            {"source", as_json(errors.source)},
                                            {"source_held", as_json(errors.source_held)},
                                            {"irradiance", as_json(errors.irradiance)},
                                            {"irradiance_held", as_json(errors.irradiance_held)}}
                         .dump(2) +
                     "\n");
    else if (!flags.quiet)
        write_output(
            fmt::format("solution      {}\nreference     {}\n", path.string(), reference.string()) +
            as_text(errors));
    const auto wrong = verdict(options, errors);
    if (!wrong.empty()) throw InputError(fmt::format("'{}': {}.", path.string(), wrong));
    return 0;
}

}  // namespace

void add_compare_command(Shell& shell) {
    const auto options = std::make_shared<CompareOptions>();
    auto command = shell.add_command(
        "compare", "Errors of a picture, or of a solution, against a reference", compare_examples,
        [options](const CommonFlags& flags) {
            return wants_solutions(*options) ? compare_solution_files(*options, flags)
                                             : compare_pictures(*options, flags);
        });
    command
        .option("A", options->picture,
                "Picture (.exr, .pfm), solution (.vtkhdf), or folder of a run")
        .required()
        .file({"exr", "pfm", "vtkhdf"})
        .folder();
    command.option("B", options->reference, "Reference, likewise")
        .required()
        .file({"exr", "pfm", "vtkhdf"})
        .folder();
    command.option("--layer", options->layer,
                   "Layer to compare; direct_single: emission + surfaces_direct + "
                   "single_scattering");
    command.option("--region", options->region, "Compare these pixels only: left,top,width,height");
    command
        .option("--difference", options->difference,
                "Write the difference as .png: red is too bright, blue too dark")
        .file({"png"});
    command
        .option("--difference-range", options->difference_range,
                "Difference in full colour, in the layer's unit; else the 99.5th percentile")
        .positive();
    command.flag("--solutions", options->solutions,
                 "Compare the folders' solutions instead of their pictures");
    command
        .option("--points", options->comparison.points,
                "Of solutions: points in the media, and as many on sides; 256 if not given")
        .between(std::size_t(1), std::size_t(1) << 20);
    command
        .option("--rays", options->comparison.rays,
                "Of solutions: gathered along at each point; 1024 if not given")
        .between(std::size_t(1), std::size_t(1) << 24);
    const auto add_limit = [&](const char* flag, std::optional<double>& limit) {
        command.option(flag, limit, "Exit with 1 if this error, as a fraction, is larger")
            .not_negative();
    };
    add_limit("--max-rmse", options->max_rmse);
    add_limit("--max-bias", options->max_bias);
    add_limit("--max-block4", options->max_block4);
    add_limit("--max-block16", options->max_block16);
}

}  // namespace tyndall::cli
