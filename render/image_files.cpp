#include "render/image_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "mesh/file_bytes.h"
#include "mesh/input_error.h"
#include "render/exr_file.h"
#include "render/pfm_file.h"
#include "render/png_file.h"

namespace tyndall::render {

namespace fs = std::filesystem;
using mesh::InputError;

namespace {

std::string ending(const fs::path& path) {
    std::string text = path.extension().string();
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

// Runs a coder; its errors get the file's name.
template <class Coder>
auto with_name(const char* what, const fs::path& path, Coder&& coder) {
    try {
        return coder();
    } catch (const InputError& error) {
        throw InputError(fmt::format("cannot {} '{}': {}.", what, path.string(), error.what()));
    }
}

}  // namespace

Image read_image(const fs::path& path) {
    const std::string kind = ending(path);
    if (kind == ".png")
        throw InputError(
            fmt::format("cannot read '{}': a PNG holds tone-mapped pixels, not "
                        "radiances. Give the .exr or .pfm of the same picture.",
                        path.string()));
    if (kind != ".exr" && kind != ".pfm")
        throw InputError(
            fmt::format("cannot read '{}': '{}' is no picture's ending. Give a file "
                        "that ends in .exr or .pfm.",
                        path.string(), kind));
    const std::string bytes = mesh::read_file(path);
    return with_name("read", path,
                     [&] { return kind == ".exr" ? decode_exr(bytes) : decode_pfm(bytes); });
}

void check_writable_image(const fs::path& path) {
    const std::string kind = ending(path);
    if (kind != ".exr" && kind != ".pfm" && kind != ".png")
        throw InputError(
            fmt::format("cannot write '{}': '{}' is no picture's ending. Give a name "
                        "that ends in .exr, .pfm or .png.",
                        path.string(), kind));
    std::error_code ignored;
    const auto folder = path.parent_path();
    if (!folder.empty() && !fs::is_directory(folder, ignored))
        throw InputError(fmt::format("cannot write '{}': there is no folder '{}'. Create it first.",
                                     path.string(), folder.string()));
}

void write_image(const fs::path& path, const Image& image) {
    check_writable_image(path);
    check_sizes(image);
    const std::string kind = ending(path);
    if (kind == ".png") return write_image(path, tone_map(image));
    mesh::write_file(path, with_name("write", path, [&] {
                         return kind == ".exr" ? encode_exr(image)
                                               : encode_pfm(image, image.layers[0]);
                     }));
}

void write_image(const fs::path& path, const DisplayImage& image) {
    check_writable_image(path);
    if (ending(path) != ".png")
        throw InputError(
            fmt::format("cannot write '{}': a tone-mapped picture goes into a .png "
                        "file. Give such a name.",
                        path.string()));
    mesh::write_file(path, with_name("write", path, [&] { return encode_png(image); }));
}

}  // namespace tyndall::render
