// Picture files by their names' endings: .exr, .pfm and, for eyes, .png.
#pragma once

#include <filesystem>

#include "render/image.h"
#include "render/tone_map.h"

namespace tyndall::render {

// Purpose: a picture from an EXR (all layers) or a PFM file (one layer, "beauty").
// Errors: mesh::InputError with the file's name: not there, not readable, of another format, cut
//   short or damaged. A PNG is refused: its pixels are no radiances.
// Cost: the whole file is in memory.
Image read_image(const std::filesystem::path& path);

// Purpose: a picture file. EXR holds all layers, PFM the picture itself (one or three channels),
//   PNG the picture itself, tone-mapped as tone_map does by default. A file appears complete or not
//   at all.
// Errors: mesh::InputError with the file's name: another ending, no such folder, no permission, …
void write_image(const std::filesystem::path& path, const Image& image);

// Purpose: a PNG file of a tone-mapped picture.
void write_image(const std::filesystem::path& path, const DisplayImage& image);

// Throws what write_image would throw because of the name alone: to be called before long work.
void check_writable_image(const std::filesystem::path& path);

}  // namespace tyndall::render
