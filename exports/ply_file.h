// Triangles as PLY files.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mesh/types.h"

namespace tyndall::exports {

struct Triangles {
    std::vector<mesh::Point> points;  // [m]
    // Corners, counter-clockwise seen from the front.
    std::vector<std::array<std::uint32_t, 3>> corners;
};

// What a point carries beside its place, all of them alike.
struct PointColumn {
    std::string name;           // "radiosity"
    std::vector<float> values;  // one a point
};

// Purpose: the bytes of a PLY file, binary, little endian: `float x y z`, `uchar red green blue`
//   where `colours` is not empty, then a `float` a column; faces as `uchar int vertex_indices`.
// Errors: an assertion where a column or the colours have not one value a point.
// Source: Turk (1994), the PLY polygon file format.
std::string ply_file(const Triangles& triangles,
                     std::span<const std::array<std::uint8_t, 3>> colours = {},
                     std::span<const PointColumn> columns = {});

}  // namespace tyndall::exports
