// Makes the frames of an animation, one after the other.
#pragma once

#include <optional>

#include "cli/animation_plan.h"
#include "cli/animation_record.h"
#include "cli/progress.h"
#include "radiosity/incremental_radiosity.h"
#include "render/image.h"

namespace tyndall::cli {

class Animator {
  public:
    // `frames`: of the whole animation.
    Animator(const std::vector<SceneFile>& frames, AnimationRecord& record, ProgressLine& progress);

    // Purpose: the frame's solution and pictures as files, and its record. False where a stop was
    //   asked for before it was whole: nothing of it is left then.
    // Errors: mesh::InputError, which names the frame.
    bool make(std::size_t frame);

  private:
    // A solution of a frame's scene, by what of this job's is still good.
    const radiosity::Solution& light(std::size_t frame, FrameRecord& record);
    void solve(std::size_t frame, FrameRecord& record);
    void superpose(std::size_t frame);
    void shoot(std::size_t segment);
    // A segment's frames with moved bodies: whether they can be had from one solution; that
    // solution, and a frame's.
    bool bodies_move(std::size_t segment);
    void begin_moving(std::size_t segment);
    void move(std::size_t frame, FrameRecord& record);
    bool write(std::size_t frame, const radiosity::Solution& solution);
    double white_of(std::size_t frame, const render::Image& image);
    std::optional<radiosity::View> view(std::size_t frame) const;

    const std::vector<SceneFile>& frames_;
    AnimationPlan plan_;
    AnimationRecord& record_;
    ProgressLine& progress_;
    std::vector<std::size_t> segment_;  // of each frame
    std::optional<std::size_t> shot_;   // the segment whose units there are
    radiosity::UnitShots shots_;
    // Of the segment whose surfaces move: what stands still, why they cannot be bodies (empty: they
    // can), the light that its frames begin with, and the first one's solution.
    struct Moving {
        std::optional<std::size_t> segment;
        std::shared_ptr<const radiosity::Enclosure> still;
        std::string obstacle;
        std::shared_ptr<radiosity::KeptLight> kept;
        radiosity::Solution first;
        std::size_t rays = 0;  // of its solve
    } moving_;
    // Of the frame solved last, for frames that differ in lights, albedo or reflectance alone.
    std::shared_ptr<radiosity::SharedRows> rows_ = std::make_shared<radiosity::SharedRows>();
    std::optional<std::size_t> solved_;  // the frame whose solution there is
    radiosity::Solution solution_;
};

}  // namespace tyndall::cli
