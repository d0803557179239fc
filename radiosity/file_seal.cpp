#include "radiosity/file_seal.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <vector>

#include "mesh/input_error.h"

namespace tyndall::radiosity {
namespace {

constexpr std::string_view mark = "Tyndall\n";
constexpr std::size_t sealed_size = 16;

// Of bytes that come in pieces; all pieces but the last are multiples of eight bytes.
class Checksum {
  public:
    void add(std::string_view bytes) {
        for (std::size_t k = 0; k < bytes.size(); k += 8) {
            std::uint64_t word = 0;
            const std::size_t count = std::min<std::size_t>(8, bytes.size() - k);
            for (std::size_t i = 0; i < count; ++i)
                word |= std::uint64_t(static_cast<unsigned char>(bytes[k + i])) << (8 * i);
            // One to one in the word and in the state: one changed word changes the end.
            state_ = (state_ ^ word) * 0x9e3779b97f4a7c15u;
            state_ ^= state_ >> 32;
        }
        size_ += bytes.size();
    }
    std::array<char, 8> bytes() const {
        const std::uint64_t value = (state_ ^ size_) * 0x9e3779b97f4a7c15u;
        std::array<char, 8> result{};
        for (std::size_t i = 0; i < 8; ++i) result[i] = static_cast<char>(value >> (8 * i));
        return result;
    }

  private:
    std::uint64_t state_ = 0, size_ = 0;
};

std::string seal_text(const Checksum& sum) {
    const auto digits = sum.bytes();
    return std::string(mark) + std::string(digits.begin(), digits.end());
}

}  // namespace

std::string seal_of(std::string_view bytes) {
    Checksum sum;
    sum.add(bytes);
    return seal_text(sum);
}

Seal check_seal(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    const auto cannot = [&] {
        return mesh::InputError(
            fmt::format("cannot read '{}'. Check its permissions and the disk.", path.string()));
    };
    if (!file) throw cannot();
    const auto size = static_cast<std::size_t>(std::max<std::streamoff>(file.tellg(), 0));
    if (size < sealed_size) return Seal::none;
    std::string end(sealed_size, '\0');
    file.seekg(static_cast<std::streamoff>(size - sealed_size));
    file.read(end.data(), sealed_size);
    if (!file) throw cannot();
    if (!end.starts_with(mark)) return Seal::none;
    file.seekg(0);
    Checksum sum;
    std::vector<char> piece(1u << 20);
    for (std::size_t left = size - sealed_size; left > 0;) {
        const std::size_t count = std::min(left, piece.size());
        if (!file.read(piece.data(), static_cast<std::streamsize>(count))) throw cannot();
        sum.add({piece.data(), count});
        left -= count;
    }
    return end == seal_text(sum) ? Seal::whole : Seal::broken;
}

}  // namespace tyndall::radiosity
