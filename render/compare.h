// How far a picture is from a reference.
#pragma once

#include <cstddef>

#include "render/image.h"
#include "render/tone_map.h"

namespace tyndall::render {

// Errors are in units of the mean of the whole reference, over all its pixels and channels.
struct PictureError {
    double mean = 0.0, reference_mean = 0.0;  // [as the layer: W/m^2/sr]
    double rmse = 0.0;                        // of single pixels [-]
    double bias = 0.0;                        // (mean − reference_mean) / reference_mean [-]
    double block4 = 0.0, block16 = 0.0;       // of the means of 4×4 and 16×16 blocks [-]
    double mape = 0.0;                        // mean of |difference| over the reference [-]
    double max_error = 0.0;                   // largest |difference| of one value [-]
    std::size_t max_x = 0, max_y = 0;         // where it is [pixel]
    std::size_t not_finite = 0;               // values of the picture that are NaN or infinite
    std::size_t negative = 0;                 // values of the picture below 0
};

// Purpose: all measures of one layer against another of the same size.
// Equation: e_n² = Σ_b |b| (mean_b(picture) − mean_b(reference))² / Σ_b |b|, over the blocks b of n
//   × n pixels (cut off at the right and lower edge, hence the weights |b|) and the channels; rmse
//   is n = 1. mape is the mean of |p − r| / (|r| + 0.01 mean |r|): dark places count as bright
//   ones do, but for what is darker than a hundredth of the mean. A block averages a reference's
//   noise away, and shows what is wrong on purpose. Values of the picture that are not finite are
//   counted, and left out with their blocks.
// Errors: mesh::InputError: sizes or channels differ; the reference has a value that is not finite,
//   or a mean of 0 while the picture differs from it.
PictureError compare(std::size_t width, std::size_t height, const Layer& picture,
                     const Layer& reference);

// A rectangle of pixels: from (left, top), which is in it.
struct Region {
    std::size_t left = 0, top = 0, width = 0, height = 0;
};

// Purpose: the region's pixels of a layer, as a layer of that size.
// Errors: mesh::InputError if there are no such pixels.
Layer region_of(std::size_t width, std::size_t height, const Layer& layer, const Region& region);

// Purpose: block error of any block size n ≥ 1, as above.
double block_error(std::size_t width, std::size_t height, const Layer& picture,
                   const Layer& reference, std::size_t n);

// Purpose: the signed difference, mean of the channels, as a picture: white where equal, red where
//   the picture is brighter than the reference, blue where it is darker, grey where it is not
//   finite.
// `range`: difference shown in full colour [as the layer].
DisplayImage difference_picture(std::size_t width, std::size_t height, const Layer& picture,
                                const Layer& reference, double range);

// Purpose: a range for difference_picture: the 99.5th percentile of |difference|, 1 if that is 0.
double difference_range(const Layer& picture, const Layer& reference);

}  // namespace tyndall::render
