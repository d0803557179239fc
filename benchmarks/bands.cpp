// What bands cost: CPU seconds of a solve with 1, 3 and 8 bands.
//
//   bands [--elements N] [--rays D] [scene.toml …]
//
// Every scene is solved grey (the mean of its bands), then with 3 and with 8 bands whose
// reflectances differ: once with one extinction for all, where rows are shared, and once with
// another extinction in every band, which is the hard case. The mesh has about N elements in all of
// them (default 20000), so that bands alone make the difference. Prints CPU seconds of the whole
// solve, of its passes, and the ratios to one band.
#include <fmt/format.h>

#include <cstdio>
#include <cstring>
#include <numeric>

#include "cli/scene_file.h"
#include "radiosity/adaptive.h"
#include "radiosity/resources.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

struct Arguments {
    std::size_t elements = 20000, rays = 256;
    std::vector<std::string> scenes;
};

double mean_of(const Spectrum& s) {
    return s.empty() ? 0.0
                     : std::accumulate(s.begin(), s.end(), 0.0) / static_cast<double>(s.size());
}

// `bands` values about the mean of what there was, from (1 − spread) to (1 + spread) times it.
void spread(Spectrum& s, std::size_t bands, double width, double most) {
    if (s.empty()) return;
    const double mean = mean_of(s);
    s.assign(bands, mean);
    for (std::size_t b = 0; bands > 1 && b < bands; ++b) {
        const double at = 2.0 * static_cast<double>(b) / static_cast<double>(bands - 1) - 1.0;
        s[b] = std::min(most, mean * (1.0 + width * at));
    }
}

Scene with_bands(Scene scene, std::size_t bands, bool extinctions) {
    constexpr double any = 1e300;
    scene.bands = bands;
    for (Material& m : scene.materials) {
        spread(m.reflectance, bands, 0.2, 0.99);
        spread(m.emission, bands, 0.2, any);
        spread(m.power, bands, 0.2, any);
    }
    for (Medium& m : scene.media) {
        spread(m.extinction, bands, extinctions ? 0.5 : 0.0, any);
        spread(m.albedo, bands, 0.05, 1.0);
        spread(m.emission, bands, 0.0, any);
        spread(m.heat, bands, 0.0, any);
    }
    for (Light& light : scene.lights)
        std::visit(
            [&](auto& source) {
                if constexpr (requires { source.irradiance; })
                    spread(source.irradiance, bands, 0.2, any);
                else
                    spread(source.intensity, bands, 0.2, any);
            },
            light.source);
    if (!scene.environment.empty()) spread(scene.environment, bands, 0.2, any);
    return scene;
}

// CPU seconds [s].
double solve(const cli::SceneFile& file, const Scene& scene, const Arguments& a) {
    SolveOptions options = file.solve;
    options.max_elements = a.elements;
    options.rays = a.rays;
    options.error = 1e-4;  // the limit on elements ends refinement
    std::optional<View> view;
    if (!file.cameras.empty()) view = file.cameras.front().view();
    const auto enclosure = std::make_shared<const Enclosure>(make_enclosure(scene));
    const double before = cpu_seconds();
    const Solution solution = solve_adaptively(enclosure, options, view);
    const double seconds = cpu_seconds() - before;
    fmt::print("{:7.1f} s ", seconds);
    for (const PassReport& pass : solution.report.passes)
        fmt::print(" {:6.1f} {}", pass.cpu_seconds, pass.stage);
    fmt::print("  ({} elements)", solution.report.patches + solution.report.zones);
    return seconds;
}

void compare(const std::string& path, const Arguments& a) {
    const auto file = cli::read_scene_file(path);
    fmt::print("{}\n  {:<24}", path, "1 band");
    const double one = solve(file, with_bands(file.scene, 1, false), a);
    fmt::print("\n");
    for (const bool extinctions : {false, true})
        for (const std::size_t bands : {3, 8}) {
            fmt::print("  {} bands, {:<15}", bands, extinctions ? "all differ" : "one extinction");
            std::fflush(stdout);
            const double seconds = solve(file, with_bands(file.scene, bands, extinctions), a);
            fmt::print("  {:.2f} times\n", seconds / one);
        }
}

}  // namespace

int main(int count, char** words) {
    Arguments a;
    for (int k = 1; k < count; ++k) {
        const std::string word = words[k];
        const auto value = [&] { return std::string(k + 1 < count ? words[++k] : "0"); };
        if (word == "--elements")
            a.elements = std::stoul(value());
        else if (word == "--rays")
            a.rays = std::stoul(value());
        else
            a.scenes.push_back(word);
    }
    if (a.scenes.empty())
        a.scenes = {TYNDALL_SOURCE_DIR "/examples/scenes/window_shafts.toml",
                    TYNDALL_SOURCE_DIR "/examples/scenes/coloured_fog.toml"};
    for (const auto& scene : a.scenes) compare(scene, a);
}
