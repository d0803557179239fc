// What a study's runs are measured by.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cli/solution_points.h"
#include "cli/study_file.h"
#include "cli/study_record.h"
#include "render/image.h"

namespace tyndall::cli {

// A reference as it is compared with.
struct Reference {
    StudyMeasure measure;
    std::string key;  // changes with what it holds
    // A picture:
    std::size_t width = 0, height = 0;
    render::Layer layer;
    // Probes:
    std::vector<SolutionPoint> points;
    PointValues values;
};

// Runs the scene with the overrides, or finds that run done, and returns its folder; "" if stopped.
using ReferenceRun = std::function<std::filesystem::path(const StudyMeasure&)>;

// Purpose: the layer of a picture that a measure looks at. A picture with one layer (PFM) is taken
//   for it.
// Errors: mesh::InputError if a layer is not there.
render::Layer measured_layer(const render::Image& image, MeasureKind kind);

// Purpose: reads a measure's reference, made by `run` first where it is a finer run. None if
//   stopped.
// Errors: mesh::InputError with the reference's place: it cannot be read, holds no such layer, …
std::optional<Reference> load_reference(const Study& study, const StudyMeasure& measure,
                                        const ReferenceRun& run,
                                        const radiosity::ProgressCallback& progress);

// Purpose: measures a done run in `folder`: fills the record's errors, keeps them in the folder,
//   and draws the difference of pictures (difference_MEASURE.png, full colour at a tenth of the
//   reference's mean). What has been measured with the same reference is kept.
// Errors: mesh::InputError: pictures of different sizes, values that are not finite, …
void measure_run(const Study& study, const Reference& reference,
                 const std::filesystem::path& folder, RunRecord& record,
                 const radiosity::ProgressCallback& progress);

}  // namespace tyndall::cli
