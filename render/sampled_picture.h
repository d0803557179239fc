// Pictures as means of random samples, and how far they may be off.
#pragma once

#include <functional>

#include "radiosity/progress.h"
#include "radiosity/solution.h"
#include "render/camera.h"
#include "render/image.h"
#include "render/options.h"
#include "render/picture_parts.h"
#include "render/random_numbers.h"

namespace tyndall::render {

// A sample of what is seen along a ray from the camera; called from many threads.
// `within`: place in the pixel's batch, and `batch`: which one, for numbers that are stratified
// over a batch.
struct SampleAt {
    std::uint64_t seed;  // of the pixel and the batch
    std::size_t within;
};
using Sampler = std::function<void(const mesh::Ray&, const SampleAt&, RandomNumbers&, Seen&)>;

struct SampledPictureOptions {
    std::size_t batch = 1;  // samples that are stratified together: their means are independent
    bool specular = false;  // there is a layer specular_reflection
};

// Purpose: the picture as the mean of samples, its layers, and a layer "error": the standard error
//   of each pixel, from the variance of its batches [W/m²/sr].
// Goals: `samples` a pixel; or, with error or time given, rounds of more and more samples until
//   estimated_block4 is below `error` or the time is up, whichever is first.
// Equation: estimated_block4 = √(⟨e²⟩ / 16) / ⟨L⟩, e the layer "error": pixels are independent (55)
// Errors: mesh::InputError for an eye in a solid.
// Same bits at any thread count, where `time` is 0. A stop by the callback leaves a picture of what
// there is.
Image sampled_picture(const radiosity::Enclosure& enclosure, const Camera& camera,
                      const RenderOptions& options, const SampledPictureOptions& how,
                      const Sampler& sampler, const radiosity::ProgressCallback& progress);

}  // namespace tyndall::render
