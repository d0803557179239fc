// What of an animation is computed anew, frame by frame.
#pragma once

#include <string>
#include <vector>

#include "cli/scene_file.h"
#include "radiosity/compare_scenes.h"

namespace tyndall::cli {

// Frames in a row whose scenes differ in emissions at most, or in the places of some surfaces at
// most, and are solved with the same settings.
struct Segment {
    std::size_t first = 0, end = 0;
    bool emissions_change = false;
    std::vector<std::size_t> moving;  // surfaces that move; solved as bodies where they can be
    // By sums of unit solutions, where that takes fewer solves than there are different frames.
    bool superposed = false;
    bool camera_moves = false;  // refinement then serves no view: it would be one frame's
};

struct AnimationPlan {
    std::vector<Segment> segments;
    // Of each frame: what differs from the frame before; of the first frame nothing.
    std::vector<std::vector<std::string>> changed;
};

// `frames`: of the whole animation, so that a part of it gives the frames that all of it would.
AnimationPlan plan_animation(const std::vector<SceneFile>& frames);

// The scenes of a segment.
std::vector<radiosity::Scene> scenes_of(const std::vector<SceneFile>& frames,
                                        const Segment& segment);

// Every frame of the scene's animation, overrides applied; of a scene without one, itself. All have
// the viewpoints of all, so that a camera that moves changes no geometry.
std::vector<SceneFile> read_frames(const std::filesystem::path& path,
                                   const std::vector<std::string>& overrides,
                                   const SceneFile& file);

}  // namespace tyndall::cli
