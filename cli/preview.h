// Pictures of a run while it goes on: OUT/preview.png, and frames of a film.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "cli/job.h"

namespace tyndall::cli {

struct PreviewChoice {
    bool wanted = false;          // --preview
    std::optional<double> every;  // --preview-every: at least so long from one to the next [s]
    bool frames = false;          // --frames: each is kept as OUT/frames/0001.png, 0002 …
};

// Surfaces in direct light without the medium as soon as the scene is meshed, then what the solve
// has, medium and all. Few rays a pixel. Nothing of it changes the solution.
class Preview {
  public:
    // Frames of an earlier run are removed. The scene must outlive this.
    Preview(const SceneFile& file, std::filesystem::path folder, const PreviewChoice& choice,
            ProgressLine& progress);

    // Whether there is anything to see and somebody to see it.
    bool active() const { return camera_ != nullptr; }
    void show_surfaces(const radiosity::Enclosure& enclosure);
    // What solve_adaptively is to call.
    decltype(radiosity::Passes::watch) watch();
    // The picture that the run ends with.
    void show_last(const render::Image& image);

  private:
    bool due() const;
    void show(const radiosity::Solution& solution);
    void write(const render::Image& image);

    const SceneFile& file_;
    std::filesystem::path folder_;
    PreviewChoice choice_;
    ProgressLine& progress_;
    const render::Camera* camera_ = nullptr;
    double shown_ = 0.0;  // radiosity::wall_seconds() of the last picture; 0: none yet [s]
    int frames_ = 0;
};

}  // namespace tyndall::cli
