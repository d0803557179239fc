// What a caller can choose about a picture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace tyndall::render {

// For RenderOptions::scattering_tolerance [-].
inline constexpr double as_elements_hold = 1e9;

struct RenderOptions {
    std::string method = "line_of_sight";
    std::size_t samples = 16;  // rays a pixel, a scrambled (0,2)-net; a power of two is best
    // line_of_sight: where radiance departs from linear, from the middle of a pixel to those of its
    // neighbours, by no more than this share of it, the middle's one ray is enough; 0: never [-].
    double contrast = 0.01;
    // line_of_sight: rays a pixel, spread over its samples, that gather indirect light right where
    // a surface is seen; 0: the patches' own functions are shown.
    std::size_t final_gather = 0;
    // Direct light on a surface is computed anew in closed form at what a ray hits, wherever the
    // patch's own function may be off by more than this share of the surfaces' mean
    // radiance.
    double direct_tolerance = 0.002;  // [-]
    // What a leaf of a medium scatters once is looked at on every fourth ray (line_of_sight),
    // wherever the leaf's own function may be off on that ray by more than this share of
    // the mean radiance of all elements; as_elements_hold: nowhere.
    double scattering_tolerance = 0.002;  // [-]
    // Of methods that draw lots (last_scatter, two_pass, path_traced): go on, whatever `samples`
    // says, until the picture's estimated error in blocks of 4 × 4 pixels, over its mean, is below
    // this; 0: no goal [-].
    double error = 0.0;
    // Or until so much wall time is spent, whichever is first; 0: no limit [s].
    double time = 0.0;
    // two_pass: scatterings by chance, the last of which takes the solution's light; 0: what the
    // media need (two_pass.h).
    std::size_t scatterings = 0;
    std::uint64_t seed = 1;
    std::size_t threads = 0;  // 0: all

    bool operator==(const RenderOptions&) const = default;
};

// From exposed radiance to the screen's light (tone_map.h).
enum class ToneCurve { shoulder, filmic, reinhard, linear };

struct ToneMapOptions {
    ToneCurve curve = ToneCurve::shoulder;
    double exposure = 0.0;        // stops added to the automatic exposure
    std::optional<double> white;  // radiance shown as white, instead of automatic [W/m^2/sr]

    bool operator==(const ToneMapOptions&) const = default;
};

}  // namespace tyndall::render
