#include "radiosity/npy_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cstring>

#include "mesh/file_bytes.h"
#include "mesh/input_error.h"

namespace tyndall::radiosity {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_values = std::size_t{1} << 27;
constexpr std::size_t most_dimensions = 32;  // NumPy's own limit

// What the header's dictionary says.
struct Header {
    std::size_t begin = 0;  // of the values, in the file [byte]
    bool doubles = false, fortran_order = false;
    std::vector<std::size_t> shape;
};

class NpyFile {
  public:
    explicit NpyFile(const fs::path& path) : name_(path.string()) {
        std::error_code error;
        const auto size = fs::file_size(path, error);
        if (!error && size > 8 * most_values + 65536)
            fail(fmt::format("it has {:.3g} GB; {} values are the most", 1e-9 * double(size),
                             most_values),
                 "Save a coarser grid");
        bytes_ = mesh::read_file(path);
    }

    RegularGrid grid(Point low, Point high) const {
        const Header header = read_header();
        const auto& n = header.shape;
        const std::size_t count = n[0] * n[1] * n[2], size = header.doubles ? 8 : 4;
        const std::size_t held = (bytes_.size() - header.begin) / size;
        if (bytes_.size() - header.begin != size * count)
            fail(fmt::format("an array of {} × {} × {} has {} values, the file {}", n[0], n[1],
                             n[2], count, held),
                 held < count ? "It may be cut short: save it again" : "Save it again");
        std::vector<float> values(count);
        // Points in our order, x fastest: Fortran's.
        for (std::size_t k = 0, at = 0; k < n[2]; ++k)
            for (std::size_t j = 0; j < n[1]; ++j)
                for (std::size_t i = 0; i < n[0]; ++i, ++at)
                    values[at] =
                        value(header, header.fortran_order ? at : (i * n[1] + j) * n[2] + k);
        try {
            return {{n[0], n[1], n[2]}, low, high, std::move(values)};
        } catch (const mesh::InputError& error) {
            throw mesh::InputError(fmt::format("{}: {}", name_, error.what()));
        }
    }

  private:
    [[noreturn]] void fail(const std::string& what, const std::string& todo) const {
        throw mesh::InputError(fmt::format("{}: {}. {}.", name_, what, todo));
    }
    [[noreturn]] void fail_header() const {
        fail("its header is damaged", "Save the array again with numpy.save");
    }

    float value(const Header& header, std::size_t index) const {
        const char* at = bytes_.data() + header.begin + index * (header.doubles ? 8 : 4);
        if (!header.doubles) {
            float value;
            std::memcpy(&value, at, 4);
            return value;
        }
        double value;
        std::memcpy(&value, at, 8);
        return static_cast<float>(value);
    }

    Header read_header() const {
        if (bytes_.substr(0, 6) != "\x93NUMPY")
            fail("this is no .npy file", "Save the array with numpy.save");
        if (bytes_.size() < 12) fail_header();
        const auto byte = [&](std::size_t at) {
            return std::size_t(static_cast<unsigned char>(bytes_[at]));
        };
        const std::size_t version = byte(6);
        if (version < 1 || version > 3)
            fail(fmt::format("version {} of the format is not known", version),
                 "Save it with numpy.save");
        std::size_t length = byte(8) + 256 * byte(9), begin = 10;
        if (version > 1) {
            length += 65536 * byte(10) + 16777216 * byte(11);
            begin = 12;
        }
        if (length > bytes_.size() - begin) fail_header();
        Header header;
        header.begin = begin + length;
        read_dictionary(bytes_.substr(begin, length), header);
        return header;
    }

    // The text behind 'key': in the dictionary.
    std::string_view behind(std::string_view dictionary, std::string_view key) const {
        const auto at = dictionary.find(fmt::format("'{}':", key));
        if (at == std::string_view::npos) fail_header();
        dictionary.remove_prefix(at + key.size() + 3);
        dictionary.remove_prefix(std::min(dictionary.find_first_not_of(' '), dictionary.size()));
        return dictionary;
    }

    void read_dictionary(const std::string& dictionary, Header& header) const {
        const auto type = behind(dictionary, "descr");
        if (type.starts_with("'<f4'") || type.starts_with("'<f8'"))
            header.doubles = type[3] == '8';
        else
            fail(fmt::format("its values are of type {}", type.substr(0, type.find_first_of(",}"))),
                 "Save them as numpy.float32 or float64, little-endian ('<f4', '<f8')");
        const auto order = behind(dictionary, "fortran_order");
        header.fortran_order = order.starts_with("True");
        if (!header.fortran_order && !order.starts_with("False")) fail_header();
        read_shape(behind(dictionary, "shape"), header);
    }

    void read_shape(std::string_view text, Header& header) const {
        if (!text.starts_with('(')) fail_header();
        const char* at = text.data() + 1;
        const char* const end = text.data() + text.size();
        while (at < end && *at != ')') {
            if (*at == ' ' || *at == ',') {
                ++at;
                continue;
            }
            std::size_t n = 0;
            const auto [next, error] = std::from_chars(at, end, n);
            if (error != std::errc() || header.shape.size() == most_dimensions) fail_header();
            header.shape.push_back(n);
            at = next;
        }
        if (at == end) fail_header();
        if (header.shape.size() != 3)
            fail(fmt::format("it has {} dimension{} ({})", header.shape.size(),
                             header.shape.size() == 1 ? "" : "s", fmt::join(header.shape, ", ")),
                 "Save an array of three, [x, y, z]");
        double count = 1.0;
        for (const std::size_t n : header.shape) count *= static_cast<double>(n);
        if (count > static_cast<double>(most_values))
            fail(fmt::format("{} × {} × {} are more than {} values", header.shape[0],
                             header.shape[1], header.shape[2], most_values),
                 "Save a coarser grid");
    }

    std::string name_;
    std::string bytes_;
};

}  // namespace

RegularGrid read_npy_grid(const fs::path& path, Point low, Point high) {
    return NpyFile(path).grid(low, high);
}

}  // namespace tyndall::radiosity
