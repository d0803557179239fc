// OpenEXR files with named layers: 32-bit floats, ZIP compression, nothing that changes from run to
// run.
#pragma once

#include <string>
#include <string_view>

#include "render/image.h"

namespace tyndall::render {

// Purpose: the bytes of an EXR file of all layers. The first layer's channels have no prefix, so
//   that every viewer shows it: Y with one band, R, G, B with three, otherwise Y (the bands' mean,
//   for viewers) and band_0, band_1, …; those of other layers are `single_scattering.Y` and so on,
//   and `depth.Z`. The attribute `layers` keeps the layers' order. The same image gives the same
//   bytes.
// Errors: mesh::InputError on a layer that cannot be named in a file.
// Cost: ZIP at about 50 MB/s.
std::string encode_exr(const Image& image);

// Purpose: the layers of any flat EXR file with channels of full resolution (half, float or
//   integer). Alpha is left out; Z beside a picture is the layer "depth"; a file without a picture
//   in its unnamed layer begins with "beauty" if it has one, else with its first layer.
// Errors: mesh::InputError, to be completed with the file's name: not an EXR file, cut short,
//   damaged, deep, subsampled, or so large that its header cannot be true.
Image decode_exr(std::string_view bytes);

}  // namespace tyndall::render
