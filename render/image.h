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

    const Layer* find(const std::string& name) const;
};

}  // namespace tyndall::render
