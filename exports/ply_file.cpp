#include "exports/ply_file.h"

#include <fmt/format.h>

#include <cassert>

#include "exports/little_endian.h"

namespace tyndall::exports {

std::string ply_file(const Triangles& triangles,
                     std::span<const std::array<std::uint8_t, 3>> colours,
                     std::span<const PointColumn> columns) {
    const std::size_t count = triangles.points.size();
    assert(colours.empty() || colours.size() == count);
    std::string bytes = fmt::format(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float "
        "y\nproperty float z\n",
        count);
    if (!colours.empty())
        bytes += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    for (const auto& column : columns) {
        assert(column.values.size() == count);
        bytes += fmt::format("property float {}\n", column.name);
    }
    bytes += fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n",
                         triangles.corners.size());
    for (std::size_t i = 0; i < count; ++i) {
        for (int k = 0; k < 3; ++k) append(bytes, static_cast<float>(triangles.points[i][k]));
        if (!colours.empty())
            for (const std::uint8_t code : colours[i]) append(bytes, code);
        for (const auto& column : columns) append(bytes, column.values[i]);
    }
    for (const auto& corners : triangles.corners) {
        append(bytes, std::uint8_t{3});
        for (const std::uint32_t corner : corners) append(bytes, corner);
    }
    return bytes;
}

}  // namespace tyndall::exports
