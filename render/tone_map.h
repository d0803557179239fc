// From radiance to a screen: exposure, a shoulder for what is too bright, sRGB, dithering.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "render/image.h"
#include "render/options.h"

namespace tyndall::render {

// Pixels as a screen shows them: sRGB, 8 bits, row by row from the top.
struct DisplayImage {
    std::size_t width = 0, height = 0;
    std::size_t channels = 1;          // 1: grey; 3: red, green, blue
    std::vector<std::uint8_t> values;  // height × width × channels
};

// Purpose: the radiance that is shown as white if nobody says otherwise [W/m^2/sr]: the one that
//   puts the logarithmic average of what is lit (brighter than a thousandth of the mean) at middle
//   grey, 0.18 of the screen's light. A few very bright pixels (a lamp) or many black ones
//   (outside) move it little. 1 for a picture without light.
// Source: Reinhard, Stark, Shirley & Ferwerda (2002), Photographic tone reproduction, section 3.1.
double automatic_white(const Image& image, const Layer& layer);

// Purpose: the screen's light, 0 to 1, for a radiance in units of the one shown as white: linear up
//   to 0.6, then a shoulder that goes into 1 with slope 0 at 1. Values above 1 are 1, negative ones
//   0.
// Equation: with x = 2.2 s (so that the linear part has slope 1 in x): f = x for x ≤ a = 0.6, else
//   f = 1 − (1−a) (1 − (x−a)/(2.2−a))^4: value and slope continue at x = a.
double shoulder(double s);

// Purpose: the screen's light, 0 to 1, for a radiance in units of the one shown as white, by one of
//   the curves; each ends in 1 at 1, values above are 1, negative ones 0.
// Equation: with x = 2.2 s: shoulder as above; linear min(x, 1), which cuts off what is brighter
//   than 1/2.2 of white; reinhard x (1 + x/2.2²) / (1 + x); filmic h(5.09 x)/h(11.2) with h(x) =
//   (x (0.15 x + 0.05) + 0.004) / (x (0.15 x + 0.5) + 0.06) − 1/15, which has a toe, too.
// Source: Reinhard et al. (2002), equation 4; J. Hable (2010), Filmic tonemapping operators.
double tone_curve(ToneCurve curve, double s);

// Names of the curves, in their order.
std::span<const std::string_view> tone_curve_names();

// Errors: mesh::InputError that lists the names there are.
ToneCurve tone_curve_named(std::string_view name);

// Purpose: the sRGB code, 0 to 1, of the screen's light, 0 to 1. Source: IEC 61966-2-1.
double srgb_encode(double light);

// Purpose: a layer (the picture itself, if none is named) as a screen shows it. One channel gives a
//   grey picture, three an RGB one, any other count the grey of their mean. Values that are not
//   finite are black (NaN, −inf) or white (inf). An 8-bit code is the floor of the exact one plus a
//   threshold from 0 to 1 that runs through the pixels as a low-discrepancy lattice: smooth walls
//   do not band, the mean over a few pixels is the exact code, codes that are whole keep their
//   value, and the picture is the same every time.
// Errors: mesh::InputError for a white that is not positive, or a layer that is not there.
// Source of the lattice: M. Roberts (2018), The unreasonable effectiveness of quasirandom sequences
// (R2).
DisplayImage tone_map(const Image& image, const ToneMapOptions& options = {},
                      const std::string& layer = "");

}  // namespace tyndall::render
