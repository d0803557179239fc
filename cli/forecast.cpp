#include "cli/forecast.h"

#include <algorithm>
#include <cmath>

#include "cli/solution_bytes.h"
#include "radiosity/exchange_methods.h"
#include "radiosity/resources.h"
#include "radiosity/start_elements.h"

namespace tyndall::cli {
namespace {

using radiosity::SolveOptions;

// The trial's goal and rays.
constexpr double looser = 4.0;
constexpr std::size_t fewer_rays = 8, fewer_gather_rays = 4;
constexpr double trial_seconds = 10.0;  // of CPU time, at most
constexpr std::size_t trial_start =
    8000;  // elements; where a solve begins with more, a coarser one

// Of example scenes between four times their goal and their goal (docs/validation.md):
constexpr double growth = 0.42;         // elements ~ error^-growth
constexpr double gather_share = 0.85;   // of the indirect pass: time ~ rays^gather_share
constexpr double entry_seconds = 6e-8;  // an entry of the rows costs in all solves together
constexpr double entry_growth = 0.8;    // entries of a row ~ rays^entry_growth
constexpr double row_growth = 2.2;      // at the peak: rows are lists that grow by doubling
constexpr double band_time = 0.18;  // that each further matrix of a walk takes, of the first one's
constexpr double smoothing_time = 2.5;  // more than the rows themselves take

constexpr std::size_t every = 4;      // row and column of the picture
constexpr double pixel_share = 0.65;  // its time ~ pixels^pixel_share: most of it goes to edges
constexpr double picture_growth = 1.0 / 3.0;  // ~ elements^…: leaves along a ray

struct SampledRows {
    double seconds = 0.0, entries = 0.0;  // of one, on one thread
};

bool has_moments(const SolveOptions& options) {
    return options.radiance != radiosity::Radiance::constant && !(options.row_detail > 0.0) &&
           options.start != radiosity::Start::single_zone;
}

// Elements at equal distances in the list, more and more of them until it takes a third of a
// second.
SampledRows sample_rows(const radiosity::Discretization& d, const SolveOptions& options) {
    const auto& method = radiosity::exchange_method(options.exchange);
    radiosity::ExchangeOptions asked;
    asked.rays = options.rays;
    asked.seed = options.seed;
    asked.settings = options.exchange_settings;
    if (method.moments && has_moments(options)) asked.radiance = radiosity::Radiance::linear;
    SampledRows sampled;
    for (std::size_t count = 4;; count *= 4) {
        const std::size_t step = std::max<std::size_t>(1, d.elements.size() / count);
        std::vector<radiosity::ElementId> rows;
        for (std::size_t i = step / 2; i < d.elements.size(); i += step) rows.emplace_back(i);
        if (rows.empty()) return sampled;
        std::size_t entries = 0;
        const double begin = radiosity::cpu_seconds();
        method.method(d, rows, asked,
                      [&](const radiosity::Row& row) { entries += row.columns.size(); });
        const double spent = radiosity::cpu_seconds() - begin;
        const double n = static_cast<double>(rows.size());
        sampled = {spent / n, static_cast<double>(entries) / n};
        if (spent > 0.3 || step == 1 || count >= 1024) return sampled;
    }
}

// The trial's solution: it ends when its time is over. CPU time, as a busy machine is no reason to
// know less.
radiosity::Solution solve_trial(const SceneFile& file,
                                std::shared_ptr<const radiosity::Enclosure> enclosure,
                                const SolveOptions& options, ProgressLine& progress) {
    std::optional<radiosity::View> view;
    if (!file.view_camera.empty()) view = find_camera(file.cameras, file.view_camera).view();
    const double begin = radiosity::cpu_seconds();
    const auto go_on = [begin, shown = progress.callback()](const radiosity::Progress& at) {
        return shown({"forecast", at.fraction, at.elements, at.residual}) &&
               radiosity::cpu_seconds() - begin < trial_seconds;
    };
    return radiosity::solve_adaptively(enclosure, options, view, go_on);
}

SolveOptions trial_options(const SolveOptions& options, bool as_it_begins) {
    SolveOptions trial = options;
    trial.error = std::min(0.9, looser * options.error);
    trial.exchange = "walked";
    trial.exchange_settings.smoothing = radiosity::Smoothing::none;
    trial.exchange_settings.interaction_radius = 0.0;
    trial.solver = "gmres";
    trial.shots = radiosity::Shots::rows;
    trial.ambient = trial.overshooting = false;
    trial.rays = std::max<std::size_t>(1, options.rays / fewer_rays);
    trial.gather_rays = std::max<std::size_t>(1, options.gather_rays / fewer_gather_rays);
    trial.promotions = 0;
    trial.max_time = 0.0;
    if (!as_it_begins) trial.element_size = 0.0;
    return trial;
}

double seconds_of(const radiosity::Report& report, const std::string& stage) {
    double seconds = 0.0;
    for (const auto& pass : report.passes)
        if (pass.stage == stage) seconds += pass.cpu_seconds;
    return seconds;
}

double ratio(std::size_t a, std::size_t b) {
    return b > 0 ? static_cast<double>(a) / static_cast<double>(b) : 1.0;
}

// The error that the trial left, in units of the goal; 1 where it met that.
double error_left(const SolveOptions& options, const radiosity::Report& trial) {
    const double left = trial.passes.empty() ? 0.0 : trial.passes.back().estimated_error;
    const bool refined = options.refinement >= radiosity::Refinement::adaptive;
    return refined ? std::max(1.0, left / options.error) : 1.0;
}

// The trial's picture, of fewer pixels, and what the whole one would take.
double picture_seconds(const SceneFile& file, const radiosity::Solution& trial, double more_leaves,
                       double more_error, ProgressLine& progress) {
    auto camera = find_camera(file.cameras, file.view_camera);
    const double pixels = static_cast<double>(camera.width * camera.height);
    camera.width = std::max<std::size_t>(1, camera.width / every);
    camera.height = std::max<std::size_t>(1, camera.height / every);
    const double fewer = static_cast<double>(camera.width * camera.height);
    auto options = file.render;
    // As many elements are looked at anew as there will be.
    options.scattering_tolerance *= more_error;
    options.direct_tolerance *= more_error;
    if (options.error > 0.0 || options.time > 0.0) options.time = 1.0;
    const double begin = radiosity::cpu_seconds();
    make_picture(trial, camera, options, progress);
    const double spent = radiosity::cpu_seconds() - begin;
    return spent * std::pow(pixels / fewer, pixel_share) * std::pow(more_leaves, picture_growth);
}

// Bands whose extinction is another have rows of their own.
double matrices(const radiosity::Enclosure& e) {
    std::size_t distinct = 0;
    for (std::size_t b = 0; b < e.bands; ++b) {
        bool is_new = true;
        for (std::size_t other = 0; other < b; ++other)
            is_new = is_new && !std::ranges::all_of(e.media, [&](const auto& medium) {
                         return medium.extinction[b] == medium.extinction[other];
                     });
        distinct += is_new ? 1 : 0;
    }
    return static_cast<double>(distinct);
}

double coarse_seconds(const SolveOptions& options, const SampledRows& rows, double start,
                      double matrices, const radiosity::Report& trial, const SolveOptions& tried) {
    const double more = start / std::max(1.0, static_cast<double>(trial.solved_elements));
    const bool walked = options.exchange == "walked";
    const double left = walked ? 1.0 - ratio(tried.rays, options.rays) : 1.0;
    const bool smoothed = options.exchange_settings.smoothing != radiosity::Smoothing::none;
    return seconds_of(trial, "coarse solution") * more +
           start * rows.seconds * (1.0 + band_time * (matrices - 1.0)) *
               (left + (smoothed ? smoothing_time : 0.0)) +
           start * rows.entries * matrices * entry_seconds;
}

double row_bytes(const SolveOptions& options) {
    const bool smoothed = options.exchange_settings.smoothing != radiosity::Smoothing::none;
    const double moments = has_moments(options) ? moment_bytes * (smoothed ? 3.0 : 1.0) : 0.0;
    return row_growth * (entry_bytes + moments) + (smoothed ? smoothing_bytes : 0.0);
}

}  // namespace

Forecast foresee(const SceneFile& file, std::shared_ptr<const radiosity::Enclosure> enclosure,
                 ProgressLine& progress) {
    const SolveOptions& options = file.solve;
    const double wall = radiosity::wall_seconds(), cpu = radiosity::cpu_seconds();
    SampledRows rows;
    Forecast forecast;
    {
        radiosity::ElementMesh mesh(*enclosure);
        make_initial_mesh(mesh, options);
        const auto elements = start_elements(*enclosure, mesh.forest(), options.start);
        forecast.start_elements = elements.size();
        rows = sample_rows({*enclosure, mesh.forest(), elements}, options);
    }
    const auto tried = trial_options(options, forecast.start_elements <= trial_start);
    const auto trial = solve_trial(file, enclosure, tried, progress);
    const auto& report = trial.report;
    const double start = static_cast<double>(forecast.start_elements);
    const double distinct = matrices(*enclosure);
    const double tried_leaves = static_cast<double>(report.patches + report.zones);
    const double error = error_left(options, report);
    const double grown = std::max(start, tried_leaves * std::pow(error, growth));
    const double most = static_cast<double>(options.max_elements);
    const double leaves = std::min(grown, most);
    const double more = leaves / std::max(1.0, tried_leaves);
    forecast.elements = static_cast<std::size_t>(leaves);
    forecast.at_least = report.stopped && grown < most;

    double passes = 0.0;
    for (const auto& pass : report.passes) passes += pass.cpu_seconds;
    const double solved = radiosity::cpu_seconds() - cpu;
    const double gathers = ratio(options.gather_rays, tried.gather_rays);
    forecast.solve_cpu_seconds =
        coarse_seconds(options, rows, start, distinct, report, tried) *
            (1.0 + double(options.promotions)) +
        seconds_of(report, "direct light") * more +
        seconds_of(report, "indirect light") * more * std::pow(gathers, gather_share) +
        std::max(0.0, solved - passes);
    if (!file.cameras.empty() && !progress.stopped())
        forecast.picture_cpu_seconds = picture_seconds(file, trial, more, error, progress);

    const double moved = start * rows.entries * distinct * row_bytes(options);
    const double already = std::pow(ratio(tried.rays, options.rays), entry_growth);
    const double leaf = leaf_bytes + leaf_band_bytes * static_cast<double>(enclosure->bands);
    forecast.memory = static_cast<double>(radiosity::peak_memory_bytes()) +
                      moved * (1.0 - already) + std::max(0.0, leaves - tried_leaves) * leaf;
    forecast.trial_cpu_seconds = radiosity::cpu_seconds() - cpu;
    const double in_wall =
        (radiosity::wall_seconds() - wall) / std::max(1e-3, forecast.trial_cpu_seconds);
    forecast.wall_seconds = (forecast.solve_cpu_seconds + forecast.picture_cpu_seconds) * in_wall;
    if (options.max_time > 0.0 && forecast.wall_seconds > options.max_time) forecast.limited = true;
    forecast.limited = forecast.limited || grown >= most ||
                       forecast.memory > static_cast<double>(options.max_memory);
    return forecast;
}

}  // namespace tyndall::cli
