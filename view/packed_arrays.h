// Numbers as text that a page can carry.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tyndall::view {

// Arrays one behind the other. Of each all first bytes of its numbers come first, then all second
// ones, and so on, little endian: neighbours have much in common, which compresses better.
class PackedArrays {
  public:
    struct Entry {
        std::string name;
        char type;  // 'f': 32-bit float; 'i': 32-bit integer
        std::size_t count;
    };

    void add(const std::string& name, std::span<const float> values);
    void add(const std::string& name, std::span<const std::int32_t> values);

    const std::vector<Entry>& entries() const { return entries_; }

    // Purpose: all bytes, compressed by gzip, in base64. The same numbers give the same text.
    std::string text() const;

  private:
    void add_bytes(const std::string& name, char type, const std::uint32_t* values,
                   std::size_t count);

    std::vector<Entry> entries_;
    std::string bytes_;
};

}  // namespace tyndall::view
