// Portable float maps: one or three channels of 32-bit floats, rows from the bottom up.
#pragma once

#include <string>
#include <string_view>

#include "render/image.h"

namespace tyndall::render {

// Purpose: the bytes of a PFM file of one layer, little endian. Exact.
// Errors: mesh::InputError if the layer has neither one nor three channels.
// Source: https://www.pauldebevec.com/Research/HDR/PFM/
std::string encode_pfm(const Image& image, const Layer& layer);

// Purpose: the picture in a PFM file of either byte order, as the layer "beauty". Values are
//   multiplied by the header's scale, if it is not ±1.
// Errors: mesh::InputError, to be completed with the file's name: not a PFM file, a header that
//   cannot be, a file longer or shorter than its header says.
Image decode_pfm(std::string_view bytes);

}  // namespace tyndall::render
