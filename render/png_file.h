// PNG files: 8-bit sRGB, for eyes.
#pragma once

#include <string>

#include "render/tone_map.h"

namespace tyndall::render {

// Purpose: the bytes of a PNG file; grey or RGB, with an sRGB chunk and no time stamp.
// Errors: mesh::InputError if the picture is larger than PNG allows.
std::string encode_png(const DisplayImage& image);

}  // namespace tyndall::render
