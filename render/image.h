// Pictures in memory: linear, row by row from the top, named layers of one or more channels.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tyndall::render {

// A rectangle of pixels; `channels` values a pixel (one a band, or one for depth). Row 0 is the
// top.
struct Layer {
    std::string name;  // "beauty", "single_scattering", …
    std::size_t channels = 1;
    std::vector<float> values;  // height × width × channels; radiance [W/m^2/sr] but for
                                // transmittance [-], depth [m]
};

struct Image {
    std::size_t width = 0, height = 0;
    std::vector<Layer> layers;  // layers[0] is the picture itself, "beauty"
    std::size_t samples = 0;    // rays a pixel that it is made of; 0: not known
    // Of pictures that say so in a layer "error": what the mean of a block of 4 × 4 pixels is off
    // by, root mean square, over the picture's mean; compare.h measures the same [-].
    double estimated_block4 = 0.0;

    const Layer* find(const std::string& name) const;
};

// Purpose: the layer of that name; "" is the picture itself, and "direct_single" the sum
//   emission + surfaces_direct + single_scattering, what light does with at most one scattering.
// Errors: mesh::InputError that lists the layers there are.
// Cost: a copy of the layer.
Layer select_layer(const Image& image, const std::string& name);

// Throws std::logic_error if an image has no layer, or a layer's size is not the image's.
void check_sizes(const Image& image);

}  // namespace tyndall::render
