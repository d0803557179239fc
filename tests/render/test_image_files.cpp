#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <unistd.h>

#include <array>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <stdexcept>

#include "mesh/file_bytes.h"
#include "mesh/input_error.h"
#include "render/exr_file.h"
#include "render/image_files.h"
#include "render/pfm_file.h"
#include "support/catch.h"

namespace {

using namespace tyndall;
using namespace tyndall::render;
namespace fs = std::filesystem;

// A folder of its own for a test, removed in the end.
struct Folder {
    fs::path path = fs::temp_directory_path() / ("tyndall_test_" + std::to_string(::getpid()));
    Folder() { fs::create_directories(path); }
    ~Folder() {
        std::error_code ignored;
        fs::remove_all(path, ignored);
    }
};

Layer layer(const std::string& name, std::size_t pixels, std::size_t channels, float seed) {
    Layer layer{name, channels, std::vector<float>(pixels * channels)};
    for (std::size_t at = 0; at < layer.values.size(); ++at)
        layer.values[at] = seed + 0.37f * static_cast<float>(at) + 1e-6f / (1.0f + at);
    return layer;
}

Image picture(std::size_t bands) {
    constexpr std::size_t width = 7, height = 37;  // more than two blocks of 16 lines
    constexpr std::size_t pixels = width * height;
    Image image{width, height, {}};
    image.layers.push_back(layer("beauty", pixels, bands, 1.0f));
    image.layers.push_back(layer("single_scattering", pixels, bands, -2.5f));
    image.layers.push_back(layer("depth", pixels, 1, 3.0f));
    image.layers.push_back(layer("emission", pixels, bands, 100.0f));
    image.layers[0].values[3] = 1e-42f;  // denormal
    image.layers[2].values[5] = std::numeric_limits<float>::infinity();
    return image;
}

// To the last bit, so that NaN equals NaN.
bool same_values(const Layer& a, const Layer& b) {
    return a.values.size() == b.values.size() &&
           std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(float)) == 0;
}

void check_same(const Image& a, const Image& b) {
    REQUIRE(a.width == b.width);
    REQUIRE(a.height == b.height);
    REQUIRE(a.layers.size() == b.layers.size());
    for (std::size_t at = 0; at < a.layers.size(); ++at) {
        CHECK(a.layers[at].name == b.layers[at].name);
        CHECK(a.layers[at].channels == b.layers[at].channels);
        CHECK(same_values(a.layers[at], b.layers[at]));
    }
}

}  // namespace

TEST_CASE("EXR: what is written is read, bit for bit, for any count of bands") {
    const std::size_t bands = GENERATE(1, 2, 3, 4, 12);
    const Folder folder;
    const auto image = picture(bands);
    write_image(folder.path / "picture.exr", image);
    check_same(image, read_image(folder.path / "picture.exr"));
}

TEST_CASE("EXR: the same picture makes the same bytes, and leaves nothing beside it") {
    const Folder folder;
    const auto image = picture(3);
    write_image(folder.path / "a.exr", image);
    write_image(folder.path / "b.EXR", image);
    CHECK(mesh::read_file(folder.path / "a.exr") == mesh::read_file(folder.path / "b.EXR"));
    const auto begin = fs::directory_iterator(folder.path);
    CHECK(std::distance(begin, fs::directory_iterator{}) == 2);
}

TEST_CASE("EXR: a file cut short anywhere is refused") {
    const auto bytes = encode_exr(picture(1));
    // Every 97th length, and all but the last byte: header, line table, pixels.
    for (std::size_t length = 0; length < bytes.size(); length += 97)
        CHECK_THROWS_AS(decode_exr(std::string_view(bytes).substr(0, length)), mesh::InputError);
    CHECK_THROWS_AS(decode_exr(std::string_view(bytes).substr(0, bytes.size() - 1)),
                    mesh::InputError);
}

TEST_CASE("EXR: damaged bytes give an error or a picture, never a crash") {
    const auto bytes = encode_exr(picture(3));
    std::uint32_t random = 12345;
    for (int round = 0; round < 400; ++round) {
        auto damaged = bytes;
        for (int change = 0; change < 3; ++change) {
            random = random * 1664525u + 1013904223u;
            damaged[(random >> 8) % (round % 2 == 0 ? 700 : damaged.size())] =
                static_cast<char>(random >> 3);
        }
        try {
            decode_exr(damaged);
        } catch (const mesh::InputError&) {
        }
    }
    SUCCEED();
}

TEST_CASE("EXR: an absurd size in the header is refused before memory is asked for") {
    const auto whole = encode_exr(picture(1));
    const auto at = whole.find("dataWindow");
    REQUIRE(at != std::string::npos);
    const std::size_t x_max = at + 11 + 6 + 4 + 8,
                      y_max = x_max + 4;  // behind name, type, size, minima
    const auto with = [&](std::size_t corner, std::int32_t side) {
        auto bytes = whole;
        std::memcpy(&bytes[corner], &side, 4);
        return bytes;
    };
    CHECK_THROWS_AS(decode_exr(with(x_max, 2000000000)), mesh::InputError);
    CHECK_THROWS_AS(decode_exr(with(y_max, 2000000000)), mesh::InputError);
    CHECK_THROWS_AS(decode_exr(with(y_max, 100000)), mesh::InputError);
    CHECK_THROWS_AS(decode_exr(with(y_max, -5)), mesh::InputError);
}

TEST_CASE("EXR: files of other programs: half floats, alpha, depth, layers, a shifted window") {
    const Folder folder;
    const auto path = folder.path / "other.exr";
    {
        Imf::Header header(4, 4);
        header.dataWindow() = Imath::Box2i({10, -3}, {11, -3});  // 2 × 1 pixels, elsewhere
        header.compression() = Imf::PIZ_COMPRESSION;
        Imf::FrameBuffer pixels;
        std::map<std::string, std::array<Imath::half, 2>> values{
            {"R", {1.0f, 2.0f}},        {"G", {3.0f, 4.0f}},       {"B", {5.0f, 6.0f}},
            {"A", {0.5f, 0.25f}},       {"Z", {7.0f, 8.0f}},       {"albedo.R", {0.1f, 0.2f}},
            {"albedo.G", {0.0f, 1.0f}}, {"albedo.B", {0.5f, 0.5f}}};
        for (auto& [name, pair] : values) {
            header.channels().insert(name, Imf::Channel(Imf::HALF));
            pixels.insert(name, Imf::Slice::Make(Imf::HALF, pair.data(), header.dataWindow()));
        }
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(pixels);
        file.writePixels(1);
    }
    const auto image = read_image(path);
    CHECK(image.width == 2);
    CHECK(image.height == 1);
    REQUIRE(image.layers.size() == 3);
    CHECK(image.layers[0].name == "beauty");
    CHECK(image.layers[0].values == std::vector<float>{1, 3, 5, 2, 4, 6});
    REQUIRE(image.find("depth"));
    CHECK(image.find("depth")->values == std::vector<float>{7, 8});
    REQUIRE(image.find("albedo"));
    CHECK(image.find("albedo")->channels == 3);
}

TEST_CASE("PFM: what is written is read, and rows go from the bottom up") {
    const Folder folder;
    for (const std::size_t channels : {1u, 3u}) {
        auto image = picture(channels);
        image.layers.resize(1);
        image.layers[0].values[1] = std::nanf("");
        write_image(folder.path / "picture.pfm", image);
        check_same(image, read_image(folder.path / "picture.pfm"));
        const auto bytes = mesh::read_file(folder.path / "picture.pfm");
        float last = 0.0f;  // of the file: the right end of the top row
        std::memcpy(&last, bytes.data() + bytes.size() - 4, 4);
        CHECK(last == image.layers[0].values[image.width * channels - 1]);
    }
}

TEST_CASE("PFM: both byte orders, and the scale") {
    const std::string big("Pf\n2 1\n1.0\n\x3f\x80\x00\x00\xc0\x00\x00\x00", 19);
    CHECK(decode_pfm(big).layers[0].values == std::vector<float>{1.0f, -2.0f});
    const std::string little("Pf 2 1 -2.5\n\x00\x00\x80\x3f\x00\x00\x00\xc0", 20);
    CHECK(decode_pfm(little).layers[0].values == std::vector<float>{2.5f, -5.0f});
}

TEST_CASE("PFM: what cannot be is refused") {
    CHECK_THROWS_WITH(decode_pfm(""), Contains("not a PFM"));
    CHECK_THROWS_WITH(decode_pfm("P6\n1 1\n255\nabc"), Contains("not a PFM"));
    CHECK_THROWS_WITH(decode_pfm("Pf\n"), Contains("width"));
    CHECK_THROWS_WITH(decode_pfm("Pf\n-3 4\n-1\n"), Contains("width"));
    CHECK_THROWS_WITH(decode_pfm("Pf\n0 4\n-1\n"), Contains("0 × 4"));
    CHECK_THROWS_WITH(decode_pfm("Pf\n4000000000 4000000000\n-1\n"), Contains("pixels"));
    CHECK_THROWS_WITH(decode_pfm("Pf\n1 1\n0\nabcd"), Contains("scale"));
    CHECK_THROWS_WITH(decode_pfm("Pf\n1 1\nnan\nabcd"), Contains("scale"));
    CHECK_THROWS_WITH(decode_pfm("Pf\n2 2\n-1\nabcd"), Contains("cut short"));
    CHECK_THROWS_WITH(decode_pfm("Pf\n1 1\n-1\nabcdefgh"), Contains("damaged"));
    const Folder folder;
    CHECK_THROWS_WITH(write_image(folder.path / "a.pfm", picture(2)),
                      Contains("a.pfm") && Contains("one channel or three"));
}

TEST_CASE("files that cannot be read or written are named") {
    const Folder folder;
    const auto image = picture(1);
    CHECK_THROWS_WITH(read_image(folder.path / "none.exr"),
                      Contains("none.exr") && Contains("No such file"));
    CHECK_THROWS_WITH(read_image(folder.path / "none.tif"), Contains(".exr or .pfm"));
    CHECK_THROWS_WITH(read_image("picture.png"), Contains("tone-mapped"));
    CHECK_THROWS_WITH(write_image(folder.path / "a.jpg", image), Contains(".jpg"));
    CHECK_THROWS_WITH(write_image(folder.path / "deep" / "a.exr", image),
                      Contains("Create it first"));
    fs::create_directory(folder.path / "taken.exr");
    CHECK_THROWS_WITH(write_image(folder.path / "taken.exr", image), Contains("folder"));
    CHECK_THROWS_WITH(read_image(folder.path / "taken.exr"), Contains("folder"));
    mesh::write_file(folder.path / "text.exr", "this is no picture");
    CHECK_THROWS_WITH(read_image(folder.path / "text.exr"),
                      Contains("text.exr") && Contains("not an EXR"));
}

TEST_CASE("a failed write leaves the old file as it was") {
    if (::access("/dev/full", W_OK) != 0) return;
    CHECK_THROWS_WITH(mesh::write_file("/dev/full", std::string(100000, 'x')),
                      Contains("No space"));
    const Folder folder;
    mesh::write_file(folder.path / "kept.pfm", "old");
    CHECK_THROWS_AS(write_image(folder.path / "kept.pfm", picture(2)), mesh::InputError);
    CHECK(mesh::read_file(folder.path / "kept.pfm") == "old");
}

TEST_CASE("writing through a link keeps the link") {
    const Folder folder;
    mesh::write_file(folder.path / "real.bin", "old");
    fs::create_symlink("real.bin", folder.path / "link.bin");
    mesh::write_file(folder.path / "link.bin", "new");
    CHECK(fs::is_symlink(folder.path / "link.bin"));
    CHECK(mesh::read_file(folder.path / "real.bin") == "new");
}

TEST_CASE("layers are found by name, and direct_single is a sum") {
    auto image = picture(3);
    CHECK(select_layer(image, "").name == "beauty");
    CHECK(select_layer(image, "depth").channels == 1);
    CHECK_THROWS_WITH(select_layer(image, "direct_single"), Contains("surfaces_direct"));
    CHECK_THROWS_WITH(select_layer(image, "nope"), Contains("single_scattering"));
    image.layers.push_back(layer("surfaces_direct", image.width * image.height, 3, 7.0f));
    const auto sum = select_layer(image, "direct_single");
    CHECK(sum.values[10] ==
          Approx(image.find("emission")->values[10] + image.find("surfaces_direct")->values[10] +
                 image.find("single_scattering")->values[10]));
}

TEST_CASE("a picture whose sizes do not agree is not written") {
    auto image = picture(1);
    image.layers[1].values.pop_back();
    CHECK_THROWS_AS(write_image("never.exr", image), std::logic_error);
}
