#include "cli/preview.h"

#include <fmt/format.h>

#include <algorithm>

#include "radiosity/first_look.h"
#include "radiosity/resources.h"
#include "render/image_files.h"

namespace tyndall::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_samples = 4;  // rays a pixel of a preview

void remove_frames(const fs::path& folder) {
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder, none))
        if (entry.path().extension() == ".png") fs::remove(entry.path());
}

}  // namespace

Preview::Preview(const SceneFile& file, fs::path folder, const PreviewChoice& choice,
                 ProgressLine& progress)
    : file_(file), folder_(std::move(folder)), choice_(choice), progress_(progress) {
    if (!choice.wanted && !choice.every && !choice.frames) return;
    if (file.cameras.empty()) return;
    camera_ = &find_camera(file.cameras, file.view_camera);
    if (!choice.frames) return;
    prepare_folder(folder_ / "frames");
    remove_frames(folder_ / "frames");
}

bool Preview::due() const {
    return active() && !progress_.stopped() &&
           (shown_ == 0.0 || radiosity::wall_seconds() - shown_ >= choice_.every.value_or(0.0));
}

void Preview::show_surfaces(const radiosity::Enclosure& enclosure) {
    if (due()) show(radiosity::first_look(enclosure, file_.solve));
}

decltype(radiosity::Passes::watch) Preview::watch() {
    if (!active()) return {};
    return [this](const std::string&, const std::function<radiosity::Solution()>& solution) {
        if (due()) show(solution());
    };
}

void Preview::show_last(const render::Image& image) {
    if (active()) write(image);
}

void Preview::show(const radiosity::Solution& solution) {
    render::RenderOptions options = file_.render;
    options.samples = std::min(options.samples, most_samples);
    const auto image = make_picture(solution, *camera_, options, progress_);
    if (!progress_.stopped()) write(image);
}

void Preview::write(const render::Image& image) {
    const auto picture = render::tone_map(image, file_.tone_map);
    render::write_image(folder_ / "preview.png", picture);
    if (choice_.frames)
        render::write_image(folder_ / "frames" / fmt::format("{:04}.png", ++frames_), picture);
    shown_ = radiosity::wall_seconds();
}

}  // namespace tyndall::cli
