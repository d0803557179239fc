#include "render/png_file.h"

#include <fmt/format.h>
#include <png.h>

#include <stdexcept>

#include "mesh/input_error.h"

namespace tyndall::render {

std::string encode_png(const DisplayImage& image) {
    if (image.values.size() != image.width * image.height * image.channels)
        throw std::logic_error("a display image whose size is not its pixels'");
    png_image description{};
    description.version = PNG_IMAGE_VERSION;
    description.width = static_cast<png_uint_32>(image.width);
    description.height = static_cast<png_uint_32>(image.height);
    description.format = image.channels == 3 ? PNG_FORMAT_RGB : PNG_FORMAT_GRAY;
    // An upper bound first: libpng would else compress twice to find the size.
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(description);
    std::string bytes(size, '\0');
    const int done = png_image_write_to_memory(&description, bytes.data(), &size, 0,
                                               image.values.data(), 0, nullptr);
    const std::string message = description.message;
    png_image_free(&description);
    if (done == 0)
        throw mesh::InputError(
            fmt::format("a picture of {} × {} pixels cannot be written as PNG ({})", image.width,
                        image.height, message));
    bytes.resize(size);
    return bytes;
}

}  // namespace tyndall::render
