// Files of tetrahedra from other programs: Gmsh MSH and TetGen.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "mesh/types.h"

namespace tyndall::mesh {

// A tetrahedron as its file has it.
struct FileTet {
    std::array<std::uint32_t, 4> corners;  // into TetFile::points
    std::uint64_t number = 0;              // the file's own
    std::size_t line = 0;                  // of the file, from 1
};

// Invariants after read_tet_file: every tet is positively oriented and not flat, no two tets have
// the same corners, every point is a corner of some tet.
struct TetFile {
    std::string name;           // of the file that holds the tets, for messages
    std::vector<Point> points;  // [m]
    std::vector<FileTet> tets;
    std::vector<std::string> notes;  // what was mended: "turned 3 of 48 tetrahedra"

    // "room.msh:120: tetrahedron 45": where a tet stands.
    std::string place(std::size_t tet) const;
};

// A tet is flat where six times its volume is below this times the cube of its longest edge [-]:
// rounding of coordinates alone moves it by some 1e-16, and no mesher makes such slivers.
inline constexpr double flat_tet = 1e-12;

// Purpose: read tetrahedra. ".msh" is Gmsh's MSH 2 or 4.1 as text; ".ele" and ".node" are TetGen's
//   pair, either of them given. Nodes that no tet uses are dropped, nodes nearer than 1e-9 of the
//   mesh's size welded, tets turned to positive orientation, tets that are there twice (Gmsh 2.2
//   writes an element once for each of its physical groups) kept once. Of second-order tets only
//   the corners count. What was done is in the notes.
// Errors: InputError with the file's name and the line: missing, empty, truncated, binary, a
//   version or element type that is not read (hexahedra, prisms, pyramids by name), an unknown or
//   doubled node, a coordinate that is not finite, a flat tet, no tet. Cost: O(n log n).
// Source: Gmsh reference manual, "MSH file format" 4.1 and 2 (legacy); TetGen manual, chapter 5.
TetFile read_tet_file(const std::filesystem::path& path);

}  // namespace tyndall::mesh
