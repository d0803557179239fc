#include "render/exr_file.h"

#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringVectorAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <map>
#include <optional>
#include <set>

#include "mesh/input_error.h"

namespace tyndall::render {

namespace {

using mesh::InputError;

constexpr const char* order_attribute = "layers";
constexpr int max_image_side = 1 << 17;                   // [pixel]
constexpr std::size_t max_values = std::size_t{1} << 30;  // of all channels: 4 GiB
constexpr std::size_t max_ratio = 20000;                  // values a byte of file; ZIP reaches 300

class BytesOut : public Imf::OStream {
  public:
    BytesOut() : OStream("memory") {}
    void write(const char data[], int count) override {
        const auto end = at_ + static_cast<std::size_t>(count);
        if (bytes.size() < end) bytes.resize(end);
        std::memcpy(bytes.data() + at_, data, static_cast<std::size_t>(count));
        at_ = end;
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t position) override { at_ = position; }

    std::string bytes;

  private:
    std::size_t at_ = 0;
};

class BytesIn : public Imf::IStream {
  public:
    explicit BytesIn(std::string_view bytes) : IStream("memory"), bytes_(bytes) {}
    bool read(char data[], int count) override {
        if (at_ > bytes_.size() || bytes_.size() - at_ < static_cast<std::size_t>(count))
            throw InputError("it is cut short");
        std::memcpy(data, bytes_.data() + at_, static_cast<std::size_t>(count));
        at_ += static_cast<std::size_t>(count);
        return at_ < bytes_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t position) override { at_ = position; }

  private:
    std::string_view bytes_;
    std::size_t at_ = 0;
};

// ---- writing

std::vector<std::string> channel_names(const Layer& layer) {
    if (layer.channels == 1) return {layer.name == "depth" ? "Z" : "Y"};
    if (layer.channels == 3) return {"R", "G", "B"};
    std::vector<std::string> names;
    for (std::size_t band = 0; band < layer.channels; ++band)
        names.push_back(fmt::format("band_{}", band));
    return names;
}

void check_names(const Image& image) {
    std::set<std::string> seen;
    for (const auto& layer : image.layers)
        if (layer.name.empty() || !seen.insert(layer.name).second)
            throw InputError(fmt::format(
                "two of its layers are named '{}'. Give each a name of its own", layer.name));
}

std::vector<float> mean_of_bands(const Layer& layer) {
    std::vector<float> means(layer.values.size() / layer.channels);
    for (std::size_t pixel = 0; pixel < means.size(); ++pixel) {
        double sum = 0.0;
        for (std::size_t band = 0; band < layer.channels; ++band)
            sum += layer.values[pixel * layer.channels + band];
        means[pixel] = static_cast<float>(sum / static_cast<double>(layer.channels));
    }
    return means;
}

// Channels of a file about to be written, and where their pixels are.
struct Output {
    Imf::Header header;
    Imf::FrameBuffer pixels;
    std::size_t width = 0;

    void add(const std::string& name, const float* values, std::size_t stride) {
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        // The slice is only read from; the library has one type for both ways.
        auto* base = reinterpret_cast<char*>(const_cast<float*>(values));
        pixels.insert(name, Imf::Slice(Imf::FLOAT, base, stride * sizeof(float),
                                       stride * sizeof(float) * width));
    }
};

// ---- reading

struct FoundLayer {
    std::string name;
    std::vector<std::string> channels;  // full names in the file, in the order of the bands
};

std::optional<std::size_t> band_index(const std::string& leaf) {
    constexpr std::string_view prefix = "band_";
    if (leaf.compare(0, prefix.size(), prefix) != 0) return std::nullopt;
    std::size_t index = 0;
    const auto [end, error] =
        std::from_chars(leaf.data() + prefix.size(), leaf.data() + leaf.size(), index);
    if (error != std::errc() || end != leaf.data() + leaf.size()) return std::nullopt;
    return index;
}

// Which of a layer's channels are its bands, in order.
std::vector<std::string> bands_of(const std::set<std::string>& leaves) {
    std::map<std::size_t, std::string> bands;
    for (const auto& leaf : leaves)
        if (const auto index = band_index(leaf)) bands.emplace(*index, leaf);
    std::vector<std::string> names;
    for (const auto& [index, leaf] : bands) names.push_back(leaf);
    if (!names.empty()) return names;
    if (leaves.count("R") && leaves.count("G") && leaves.count("B")) return {"R", "G", "B"};
    if (leaves.count("Y")) return {"Y"};
    for (const auto& leaf : leaves)
        if (leaf != "A" && (leaf != "Z" || leaves.size() == 1)) names.push_back(leaf);
    return names;
}

std::vector<FoundLayer> find_layers(const Imf::ChannelList& channels) {
    std::map<std::string, std::set<std::string>> leaves_of;
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
        if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1)
            throw InputError(fmt::format(
                "its channel '{}' is subsampled; convert it to full resolution", channel.name()));
        const std::string full = channel.name();
        const auto dot = full.rfind('.');
        if (dot == std::string::npos)
            leaves_of[""].insert(full);
        else
            leaves_of[full.substr(0, dot)].insert(full.substr(dot + 1));
    }
    std::vector<FoundLayer> layers;
    for (const auto& [prefix, leaves] : leaves_of) {
        FoundLayer layer{prefix.empty() ? "beauty" : prefix, bands_of(leaves)};
        const std::string dotted = prefix.empty() ? "" : prefix + ".";
        for (auto& name : layer.channels) name = dotted + name;
        if (!layer.channels.empty()) layers.push_back(std::move(layer));
    }
    if (leaves_of[""].count("Z") && leaves_of.count("depth") == 0 && leaves_of[""].size() > 1)
        layers.push_back({"depth", {"Z"}});
    return layers;
}

// In the order in which they were written if the file tells, with the picture itself first.
void sort_layers(std::vector<FoundLayer>& layers, const Imf::Header& header) {
    std::vector<std::string> order{"beauty"};
    if (const auto* kept = header.findTypedAttribute<Imf::StringVectorAttribute>(order_attribute))
        order = kept->value();
    const auto rank = [&](const FoundLayer& layer) {
        return std::find(order.begin(), order.end(), layer.name) - order.begin();
    };
    std::stable_sort(layers.begin(), layers.end(),
                     [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
}

void check_believable(std::size_t width, std::size_t height, std::size_t channels,
                      std::size_t file_size) {
    const double values =
        static_cast<double>(width) * static_cast<double>(height) * static_cast<double>(channels);
    if (values > static_cast<double>(max_values) ||
        values > static_cast<double>(max_ratio) * static_cast<double>(file_size))
        throw InputError(
            fmt::format("its header says {} × {} pixels with {} channels, too much for "
                        "its {} bytes or for this program",
                        width, height, channels, file_size));
}

Image read_layers(Imf::InputFile& file, std::size_t file_size) {
    const auto window = file.header().dataWindow();
    Image image;
    image.width = static_cast<std::size_t>(std::int64_t{window.max.x} - window.min.x + 1);
    image.height = static_cast<std::size_t>(std::int64_t{window.max.y} - window.min.y + 1);
    auto found = find_layers(file.header().channels());
    if (found.empty()) throw InputError("it has no channels");
    sort_layers(found, file.header());
    std::size_t channels = 0;
    for (const auto& layer : found) channels += layer.channels.size();
    check_believable(image.width, image.height, channels, file_size);

    Imf::FrameBuffer pixels;
    image.layers.reserve(found.size());
    for (const auto& layer : found) {
        const std::size_t stride = layer.channels.size();
        image.layers.push_back({layer.name, stride, {}});
        auto& values = image.layers.back().values;
        values.resize(image.width * image.height * stride);
        for (std::size_t band = 0; band < stride; ++band)
            pixels.insert(
                layer.channels[band],
                Imf::Slice::Make(Imf::FLOAT, values.data() + band, window, stride * sizeof(float),
                                 stride * sizeof(float) * image.width));
    }
    file.setFrameBuffer(pixels);
    file.readPixels(window.min.y, window.max.y);
    return image;
}

}  // namespace

std::string encode_exr(const Image& image) {
    check_names(image);
    Output output;
    output.width = image.width;
    output.header = Imf::Header(static_cast<int>(image.width), static_cast<int>(image.height));
    output.header.compression() = Imf::ZIP_COMPRESSION;
    const auto& beauty = image.layers.front();
    std::vector<float> mean;
    std::vector<std::string> order;
    for (const auto& layer : image.layers) {
        const auto names = channel_names(layer);
        const std::string prefix = &layer == &beauty ? "" : layer.name + ".";
        for (std::size_t band = 0; band < names.size(); ++band)
            output.add(prefix + names[band], layer.values.data() + band, layer.channels);
        order.push_back(layer.name);
    }
    order.front() = "beauty";  // what the unnamed layer is called when it is read
    if (beauty.channels != 1 && beauty.channels != 3) {
        mean = mean_of_bands(beauty);
        output.add("Y", mean.data(), 1);
    }
    output.header.insert(order_attribute, Imf::StringVectorAttribute(order));
    BytesOut bytes;
    try {
        Imf::OutputFile file(bytes, output.header);
        file.setFrameBuffer(output.pixels);
        file.writePixels(static_cast<int>(image.height));
    } catch (const std::exception& error) {
        throw InputError(fmt::format("it cannot be written as EXR ({})", error.what()));
    }
    return std::move(bytes.bytes);
}

Image decode_exr(std::string_view bytes) {
    if (bytes.substr(0, 4) != std::string_view("\x76\x2f\x31\x01", 4))
        throw InputError("it is not an EXR file");
    // The library's own check, before it allocates anything in proportion to the height.
    Imf::Header::setMaxImageSize(max_image_side, max_image_side);
    try {
        BytesIn stream(bytes);
        Imf::InputFile file(stream);
        if (!file.isComplete()) throw InputError("it is cut short");
        return read_layers(file, bytes.size());
    } catch (const InputError&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw InputError(
            fmt::format("it is a damaged EXR file, or one of a kind that is not "
                        "understood ({})",
                        error.what()));
    }
}

}  // namespace tyndall::render
