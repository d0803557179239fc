// Points for probes, from CSV.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "mesh/types.h"

namespace tyndall::cli {

struct PointsFile {
    struct Row {
        mesh::Point x{0.0};
        mesh::Direction normal{0.0};  // as given; 0 without normals
        std::size_t line = 0;         // in the file, from 1
    };
    bool has_normals = false;
    std::vector<Row> rows;
};

// Purpose: points from lines "x,y,z" or "x,y,z,nx,ny,nz", all of one kind; a first line with these
//   names may stand above them. Empty lines, lines that begin with '#', spaces, CRLF and a byte
//   order mark are skipped.
// Errors: mesh::InputError "file:line: …": other columns, what is no finite number, a normal of
//   length 0, no point at all.
PointsFile parse_points(std::string_view text, const std::filesystem::path& name);

}  // namespace tyndall::cli
