// Mesh files: OBJ, PLY, STL and OFF as lists of named faces.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mesh/shapes.h"

namespace tyndall::mesh {

struct MeshFile {
    std::vector<Face>
        faces;  // a group each, in the file's order; one without a name if it has no groups
    std::vector<std::string> notes;  // what was mended: "welded 12 of 48 vertices"
};

// Purpose: read a mesh, weld vertices nearer than 1e-6 of its size, drop faces without area and
//   faces that are there twice, cut polygons that are not planar into triangles.
// OBJ is read here, in double precision, with its groups (`g`, else `o`); PLY, STL and OFF by
//   OpenMesh, which rounds coordinates to float (welding mends what that parted).
// Errors: InputError with the file's name, and the line where there is one: missing, empty,
//   truncated, not of its format, an unknown extension, an index out of range, a coordinate that is
//   not finite, no face left. Cost: O(n log n).
MeshFile read_mesh_file(const std::filesystem::path& path);

}  // namespace tyndall::mesh
