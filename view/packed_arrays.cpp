#include "view/packed_arrays.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <stdexcept>

#include "view/base64.h"

namespace tyndall::view {
namespace {

std::string gzip(const std::string& bytes) {
    z_stream stream{};
    constexpr int window = 15 + 16;  // the largest, with gzip's header, which has no time in it
    if (deflateInit2(&stream, 9, Z_DEFLATED, window, 9, Z_DEFAULT_STRATEGY) != Z_OK)
        throw std::runtime_error("zlib cannot begin to compress.");
    std::string result(deflateBound(&stream, bytes.size()), '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(result.data());
    stream.avail_out = static_cast<uInt>(result.size());
    const int status = deflate(&stream, Z_FINISH);
    result.resize(stream.total_out);
    deflateEnd(&stream);
    if (status != Z_STREAM_END) throw std::runtime_error("zlib did not compress to the end.");
    return result;
}

}  // namespace

void PackedArrays::add_bytes(const std::string& name, char type, const std::uint32_t* values,
                             std::size_t count) {
    entries_.push_back({name, type, count});
    for (int shift = 0; shift < 32; shift += 8)
        for (std::size_t i = 0; i < count; ++i)
            bytes_ += static_cast<char>(values[i] >> shift & 255u);
}

void PackedArrays::add(const std::string& name, std::span<const float> values) {
    std::vector<std::uint32_t> bits;
    bits.reserve(values.size());
    for (const float value : values) bits.push_back(std::bit_cast<std::uint32_t>(value));
    add_bytes(name, 'f', bits.data(), bits.size());
}

void PackedArrays::add(const std::string& name, std::span<const std::int32_t> values) {
    const std::vector<std::uint32_t> bits(values.begin(), values.end());
    add_bytes(name, 'i', bits.data(), bits.size());
}

std::string PackedArrays::text() const {
    return base64(gzip(bytes_));
}

}  // namespace tyndall::view
