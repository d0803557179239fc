#include "cli/study_reference.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "cli/points_file.h"
#include "cli/probe_values_file.h"
#include "cli/toml_reader.h"
#include "mesh/file_bytes.h"
#include "mesh/input_error.h"
#include "radiosity/solution_file.h"
#include "render/compare.h"
#include "render/image_files.h"

namespace tyndall::cli {
namespace {

namespace fs = std::filesystem;
constexpr double difference_share = 0.1;  // of the reference's mean, in full colour

fs::path picture_in(const fs::path& path) {
    std::error_code error;
    if (!fs::is_directory(path, error) && path.extension() != ".vtkhdf") return path;
    const auto folder = fs::is_directory(path, error) ? path : path.parent_path();
    const auto picture = folder / "image.exr";
    if (!fs::exists(picture, error))
        throw mesh::InputError(
            fmt::format("'{}' has no picture. Make one: tyndall render '{}' -o "
                        "'{}'.",
                        path.string(), path.string(), picture.string()));
    return picture;
}

fs::path solution_in(const fs::path& path) {
    std::error_code error;
    return fs::is_directory(path, error) ? path / "solution.vtkhdf" : path;
}

render::Layer sum_of(const render::Image& image, std::initializer_list<const char*> names) {
    render::Layer sum;
    for (const char* name : names) {
        const auto layer = render::select_layer(image, name);
        if (sum.values.empty()) {
            sum = layer;
            continue;
        }
        for (std::size_t k = 0; k < sum.values.size(); ++k) sum.values[k] += layer.values[k];
    }
    return sum;
}

void load_picture(const fs::path& path, Reference& reference) {
    const auto picture = picture_in(path);
    const auto image = render::read_image(picture);
    reference.width = image.width;
    reference.height = image.height;
    reference.layer = measured_layer(image, reference.measure.kind);
    reference.key = digest(mesh::read_file(picture));
}

std::vector<SolutionPoint> points_of(const Study& study, const radiosity::Enclosure& enclosure) {
    if (study.points.empty()) return sample_points(enclosure, study.probe_count);
    std::vector<SolutionPoint> points;
    for (const auto& row : parse_points(mesh::read_file(study.points), study.points).rows)
        points.push_back({row.x, row.normal});
    return points;
}

std::string probes_text(const Study& study, const Reference& reference) {
    auto text = fmt::format("{} rays\n", study.probe_rays);
    for (std::size_t k = 0; k < reference.points.size(); ++k) {
        const auto& p = reference.points[k];
        fmt::format_to(std::back_inserter(text), "{} {} {} {} {} {} {}\n", p.x.x, p.x.y, p.x.z,
                       p.normal.x, p.normal.y, p.normal.z, fmt::join(reference.values[k], " "));
    }
    return text;
}

void load_probes(const Study& study, const fs::path& path, Reference& reference,
                 const radiosity::ProgressCallback& progress) {
    if (path.extension() == ".csv") {
        if (!study.points.empty())
            fail_at(study.points_place,
                    "points are given, and a reference that has its own. Leave the points out.");
        auto table = parse_probe_values(mesh::read_file(path), path);
        reference.points = std::move(table.points);
        reference.values = std::move(table.values);
    } else {
        const auto file = radiosity::read_solution(solution_in(path));
        reference.points = points_of(study, *file.solution.enclosure);
        reference.values =
            probed_values(file.solution, reference.points, study.probe_rays, progress);
    }
    reference.key = digest(probes_text(study, reference));
}

MeasureErrors picture_errors(const Reference& reference, const fs::path& folder) {
    const auto image = render::read_image(folder / "image.exr");
    const auto layer = measured_layer(image, reference.measure.kind);
    if (image.width != reference.width || image.height != reference.height)
        throw mesh::InputError(fmt::format(
            "the picture has {} × {} pixels and the reference of {} has {} × {}.", image.width,
            image.height, reference.measure.name(), reference.width, reference.height));
    const auto e = render::compare(image.width, image.height, layer, reference.layer);
    if (e.not_finite > 0)
        throw mesh::InputError(
            fmt::format("{} values of the picture are not finite.", e.not_finite));
    const double unit = std::abs(e.reference_mean);
    const double range =
        unit > 0.0 ? difference_share * unit : render::difference_range(layer, reference.layer);
    render::write_image(
        folder / fmt::format("difference_{}.png", reference.measure.name()),
        render::difference_picture(image.width, image.height, layer, reference.layer, range));
    return {e.rmse, e.bias, e.block4, e.block16};
}

// Points in space and on sides count alike, however many there are.
MeasureErrors probe_errors(const Study& study, const Reference& reference, const fs::path& folder,
                           const radiosity::ProgressCallback& progress) {
    const auto file = radiosity::read_solution(folder / "solution.vtkhdf");
    const auto values = probed_values(file.solution, reference.points, study.probe_rays, progress);
    double squares = 0.0, bias = 0.0, kinds = 0.0;
    for (const auto kind : {PointKind::in_space, PointKind::on_sides}) {
        const auto errors = point_errors(reference.points, kind, values, reference.values);
        if (!errors) continue;
        squares += errors->rmse * errors->rmse;
        bias += errors->bias;
        kinds += 1.0;
    }
    if (kinds == 0.0)
        throw mesh::InputError(
            "no probe has as many values as the reference. Give probe values "
            "with the scene's bands.");
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    return {std::sqrt(squares / kinds), bias / kinds, nan, nan};
}

}  // namespace

render::Layer measured_layer(const render::Image& image, MeasureKind kind) {
    const bool one_layer = image.layers.size() == 1;
    if (kind == MeasureKind::picture || one_layer) return render::select_layer(image, "");
    if (kind == MeasureKind::single_scattering) return render::select_layer(image, "direct_single");
    if (kind == MeasureKind::surfaces)
        return sum_of(image, {"surfaces_direct", "surfaces_indirect"});
    return sum_of(image, {"single_scattering", "multiple_scattering"});
}

std::optional<Reference> load_reference(const Study& study, const StudyMeasure& measure,
                                        const ReferenceRun& run,
                                        const radiosity::ProgressCallback& progress) {
    fs::path path = measure.reference.file;
    if (path.empty()) path = run(measure);
    if (path.empty()) return std::nullopt;
    Reference reference;
    reference.measure = measure;
    try {
        if (measure.of_picture())
            load_picture(path, reference);
        else
            load_probes(study, path, reference, progress);
    } catch (const mesh::InputError& error) {
        fail_at(measure.reference.place,
                fmt::format("the reference of {}: {}", measure.name(), error.what()));
    }
    return reference;
}

void measure_run(const Study& study, const Reference& reference, const fs::path& folder,
                 RunRecord& record, const radiosity::ProgressCallback& progress) {
    const std::string name(reference.measure.name());
    const auto found = record.measured.find(name);
    const bool drawn = !reference.measure.of_picture() ||
                       fs::exists(folder / fmt::format("difference_{}.png", name));
    if (found != record.measured.end() && found->second == reference.key && drawn) return;
    record.errors[name] = reference.measure.of_picture()
                              ? picture_errors(reference, folder)
                              : probe_errors(study, reference, folder, progress);
    record.measured[name] = reference.key;
    write_record(folder, record);
}

}  // namespace tyndall::cli
