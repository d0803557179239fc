#include "cli/animator.h"

#include <fmt/format.h>

#include "cli/job.h"
#include "mesh/input_error.h"
#include "radiosity/moving_bodies.h"
#include "radiosity/resources.h"
#include "radiosity/solution_file.h"
#include "render/image_files.h"
#include "render/renderers.h"

namespace tyndall::cli {
namespace {

using radiosity::cpu_seconds;

constexpr const char* no_view =
    "the camera moves while the light stays: elements are refined for the solution as a whole "
    "(solve.refinement \"adaptive\"), not for one frame's view.";

// Of the first rows, that they were another frame's.
bool rows_kept(const radiosity::Solution& solution) {
    const auto& passes = solution.report.passes;
    return !passes.empty() && passes.front().rays == 0;
}

std::size_t rays_of(const radiosity::Solution& solution) {
    std::size_t rays = 0;
    for (const auto& pass : solution.report.passes) rays += pass.rays;
    return rays;
}

}  // namespace

Animator::Animator(const std::vector<SceneFile>& frames, AnimationRecord& record,
                   ProgressLine& progress)
    : frames_(frames), plan_(plan_animation(frames)), record_(record), progress_(progress) {
    for (std::size_t s = 0; s < plan_.segments.size(); ++s)
        segment_.resize(plan_.segments[s].end, s);
}

std::optional<radiosity::View> Animator::view(std::size_t frame) const {
    const SceneFile& file = frames_[frame];
    if (file.view_camera.empty() || plan_.segments[segment_[frame]].camera_moves) return {};
    return find_camera(file.cameras, file.view_camera).view();
}

// All sources at their largest tell whether the light of any frame is bounded.
void Animator::shoot(std::size_t index) {
    const Segment& segment = plan_.segments[index];
    const double began = cpu_seconds();
    *rows_ = {};  // others are going to be needed, and memory
    const auto scenes = scenes_of(frames_, segment);
    SceneFile largest = frames_[segment.first];
    largest.scene = radiosity::group_sources(scenes).largest;
    const auto enclosure = mesh_scene(largest, progress_);
    shots_ = radiosity::shoot_units(scenes, *enclosure, largest.solve, view(segment.first),
                                    progress_.callback());
    if (progress_.stopped()) return;
    shot_ = index;
    UnitsRecord units{segment.first, segment.end, {}, {}, shots_.solves, cpu_seconds() - began};
    for (const auto& group : shots_.groups.groups) units.groups.push_back(group.sources);
    record_.add(std::move(units));
}

void Animator::superpose(std::size_t frame) {
    const Segment& segment = plan_.segments[segment_[frame]];
    solution_ = radiosity::superposed(shots_, frame - segment.first, frames_[frame].scene);
}

void Animator::solve(std::size_t frame, FrameRecord& record) {
    const SceneFile& file = frames_[frame];
    radiosity::Passes passes;
    passes.rows = rows_;
    solution_ = radiosity::solve_adaptively(mesh_scene(file, progress_), file.solve, view(frame),
                                            progress_.callback(), passes);
    record.rows_kept = rows_kept(solution_);
}

// All frames are asked, so that a part of them is solved as all would be.
bool Animator::bodies_move(std::size_t index) {
    const Segment& segment = plan_.segments[index];
    if (segment.moving.empty()) return false;
    if (moving_.segment == index) return moving_.obstacle.empty();
    moving_ = {};
    moving_.segment = index;
    SceneFile still = frames_[segment.first];
    moving_.obstacle = radiosity::why_nothing_kept(still.solve);
    for (std::size_t f = segment.first; f < segment.end && moving_.obstacle.empty(); ++f) {
        const std::string& method = frames_[f].render.method;
        if (!frames_[f].cameras.empty() && !render::renderer_named(method).bodies)
            moving_.obstacle = fmt::format("is drawn by \"{}\"", method);
    }
    if (!moving_.obstacle.empty()) return false;
    still.scene = radiosity::without_surfaces(still.scene, segment.moving);
    moving_.still = mesh_scene(still, progress_);
    for (std::size_t f = segment.first; f < segment.end && moving_.obstacle.empty(); ++f)
        moving_.obstacle =
            radiosity::why_no_bodies(frames_[f].scene, segment.moving, *moving_.still);
    return moving_.obstacle.empty();
}

void Animator::begin_moving(std::size_t index) {
    const Segment& segment = plan_.segments[index];
    const SceneFile& file = frames_[segment.first];
    const double began = cpu_seconds();
    *rows_ = {};
    auto kept = std::make_shared<radiosity::KeptLight>(file.scene.bands);
    radiosity::Passes passes;
    passes.keep = kept;
    moving_.first = radiosity::solve_adaptively(
        std::make_shared<const radiosity::Enclosure>(
            radiosity::with_bodies(*moving_.still, file.scene, segment.moving)),
        file.solve, view(segment.first), progress_.callback(), passes);
    if (progress_.stopped()) return;
    moving_.rays = rays_of(moving_.first);
    moving_.kept = std::move(kept);
    UnitsRecord units{segment.first, segment.end, {}, {}, 1, cpu_seconds() - began};
    for (const std::size_t s : segment.moving) units.moving.push_back(file.scene.surfaces[s].name);
    record_.add(std::move(units));
}

void Animator::move(std::size_t frame, FrameRecord& record) {
    const SceneFile& file = frames_[frame];
    const Segment& segment = plan_.segments[segment_[frame]];
    record.rays_share = 0.0;
    if (radiosity::compare_scenes(frames_[segment.first].scene, file.scene).change ==
        radiosity::SceneChange::nothing) {
        solution_ = moving_.first;
        return;
    }
    radiosity::Passes passes;
    passes.moved = moving_.kept;
    solution_ = radiosity::solve_adaptively(
        std::make_shared<const radiosity::Enclosure>(
            radiosity::with_bodies(*moving_.still, file.scene, segment.moving)),
        file.solve, view(frame), progress_.callback(), passes);
    record.rays_share = static_cast<double>(rays_of(solution_)) / static_cast<double>(moving_.rays);
}

const radiosity::Solution& Animator::light(std::size_t frame, FrameRecord& record) {
    const std::size_t index = segment_[frame];
    const bool same =
        solved_ && segment_[*solved_] == index &&
        radiosity::compare_scenes(frames_[*solved_].scene, frames_[frame].scene).change ==
            radiosity::SceneChange::nothing;
    if (plan_.segments[index].superposed && shot_ != index) shoot(index);
    const bool moves = !same && bodies_move(index);
    if (moves && !moving_.kept) begin_moving(index);
    const double began = cpu_seconds();  // units have a record of their own
    if (!same && !progress_.stopped()) {
        solved_.reset();
        if (plan_.segments[index].superposed)
            superpose(frame);
        else if (moves)
            move(frame, record);
        else
            solve(frame, record);
    }
    record.done = same                               ? "kept"
                  : plan_.segments[index].superposed ? "superposed"
                  : moves                            ? "moved"
                                                     : "solved";
    record.cpu_seconds = cpu_seconds() - began;
    if (!progress_.stopped()) solved_ = frame;
    return solution_;
}

// The same in all frames: that of the first picture, unless the scene gives one.
double Animator::white_of(std::size_t frame, const render::Image& image) {
    const auto& given = frames_[frame].tone_map.white;
    if (!record_.white)
        record_.white =
            given ? *given : render::automatic_white(image, render::select_layer(image, ""));
    return given.value_or(*record_.white);
}

bool Animator::write(std::size_t frame, const radiosity::Solution& solution) {
    const SceneFile& file = frames_[frame];
    std::optional<render::Image> image;
    if (!file.cameras.empty())
        image = make_picture(solution, find_camera(file.cameras, file.view_camera), file.render,
                             progress_);
    if (progress_.stopped()) return false;
    radiosity::write_solution(record_.solution(frame), solution, attachments_json(file));
    if (!image) return true;
    render::ToneMapOptions tone_map = file.tone_map;
    tone_map.white = white_of(frame, *image);
    render::write_image(record_.picture(frame, "exr"), *image);
    render::write_image(record_.picture(frame, "png"), render::tone_map(*image, tone_map));
    return true;
}

bool Animator::make(std::size_t frame) {
    progress_.begin_with(fmt::format("frame {} of {}: ", frame + 1, frames_.size()));
    try {
        FrameRecord record;
        record.changed = plan_.changed[frame];
        const auto& solution = light(frame, record);
        if (progress_.stopped()) return false;
        const double began = cpu_seconds();
        if (!write(frame, solution)) return false;
        record.picture_cpu_seconds = cpu_seconds() - began;
        record.estimated_error = solution.report.estimated_error;
        record.patches = solution.report.patches;
        record.zones = solution.report.zones;
        record.warnings = solution.report.warnings;
        if (plan_.segments[segment_[frame]].camera_moves) record.warnings.push_back(no_view);
        if (record.done == "solved" && !moving_.obstacle.empty() &&
            moving_.segment == segment_[frame])
            record.warnings.push_back(fmt::format(
                "what moves is solved anew in every frame, since it {}.", moving_.obstacle));
        record_.add(frame, std::move(record));
        return true;
    } catch (const mesh::InputError& error) {
        throw mesh::InputError(
            fmt::format("in frame {} of the animation: {}", frame, error.what()));
    }
}

}  // namespace tyndall::cli
