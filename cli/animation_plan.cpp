#include "cli/animation_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/job.h"
#include "radiosity/moving_bodies.h"
#include "radiosity/source_groups.h"

namespace tyndall::cli {
namespace {

using radiosity::compare_scenes;
using radiosity::SceneChange;

const render::Camera* view_camera(const SceneFile& file) {
    return file.view_camera.empty() ? nullptr : &find_camera(file.cameras, file.view_camera);
}

bool same_view(const SceneFile& a, const SceneFile& b) {
    const auto *first = view_camera(a), *second = view_camera(b);
    return first && second ? *first == *second : first == second;
}

bool same_solve(const SceneFile& a, const SceneFile& b) {
    return a.solve == b.solve && a.tetrahedra == b.tetrahedra && a.mirrors == b.mirrors;
}

std::vector<std::string> changes(const SceneFile& before, const SceneFile& after) {
    auto what = compare_scenes(before.scene, after.scene).what;
    for (const auto& camera : after.cameras)
        for (const auto& old : before.cameras)
            if (old.name == camera.name && !(old == camera))
                what.push_back(fmt::format("camera \"{}\"", camera.name));
    if (before.view_camera != after.view_camera) what.push_back("camera");
    if (!same_solve(before, after)) what.push_back("settings of the solve");
    if (!(before.render == after.render) || !(before.tone_map == after.tone_map))
        what.push_back("settings of the picture");
    return what;
}

// One solve for the mesh and one a group; where there is one group, the mesh's is that group's.
bool sums_are_cheaper(const std::vector<SceneFile>& frames, const Segment& segment) {
    std::size_t different = 1;
    for (std::size_t f = segment.first + 1; f < segment.end; ++f)
        if (compare_scenes(frames[f - 1].scene, frames[f].scene).change != SceneChange::nothing)
            ++different;
    if (different < 2) return false;
    const auto scenes = scenes_of(frames, segment);
    const std::size_t groups = radiosity::group_sources(scenes).groups.size();
    return different > (groups <= 1 ? 1 : groups + 1);
}

// Whether a frame goes on with a segment: both kinds of change at once would be neither.
bool joins(const std::vector<SceneFile>& frames, std::size_t frame, Segment& segment) {
    const SceneFile &first = frames[segment.first], &now = frames[frame];
    if (!same_solve(first, now)) return false;
    if (const auto moved = radiosity::moved_surfaces(first.scene, now.scene)) {
        if (segment.emissions_change && !moved->empty()) return false;
        std::vector<std::size_t> all;
        std::set_union(segment.moving.begin(), segment.moving.end(), moved->begin(), moved->end(),
                       std::back_inserter(all));
        segment.moving = std::move(all);
        return true;
    }
    if (!segment.moving.empty()) return false;
    segment.emissions_change = true;
    return compare_scenes(first.scene, now.scene).change <= SceneChange::emission;
}

}  // namespace

std::vector<radiosity::Scene> scenes_of(const std::vector<SceneFile>& frames,
                                        const Segment& segment) {
    std::vector<radiosity::Scene> scenes;
    for (std::size_t f = segment.first; f < segment.end; ++f) scenes.push_back(frames[f].scene);
    return scenes;
}

AnimationPlan plan_animation(const std::vector<SceneFile>& frames) {
    AnimationPlan plan;
    for (std::size_t f = 0; f < frames.size(); ++f) {
        plan.changed.push_back(f == 0 ? std::vector<std::string>()
                                      : changes(frames[f - 1], frames[f]));
        if (f == 0 || !joins(frames, f, plan.segments.back()))
            plan.segments.push_back({f, f, false, {}});
        Segment& segment = plan.segments.back();
        segment.end = f + 1;
        segment.camera_moves = segment.camera_moves || !same_view(frames[segment.first], frames[f]);
    }
    for (Segment& segment : plan.segments)
        segment.superposed = segment.moving.empty() && sums_are_cheaper(frames, segment);
    return plan;
}

std::vector<SceneFile> read_frames(const std::filesystem::path& path,
                                   const std::vector<std::string>& overrides,
                                   const SceneFile& file) {
    if (!file.animation) return {file};
    std::vector<SceneFile> frames;
    std::vector<mesh::Point> viewpoints;
    for (std::size_t f = 0; f < file.animation->frames; ++f) {
        frames.push_back(read_scene_frame(path, overrides, *file.animation, f));
        for (const auto& eye : frames.back().scene.viewpoints)
            if (std::find(viewpoints.begin(), viewpoints.end(), eye) == viewpoints.end())
                viewpoints.push_back(eye);
    }
    for (SceneFile& frame : frames) frame.scene.viewpoints = viewpoints;
    return frames;
}

}  // namespace tyndall::cli
