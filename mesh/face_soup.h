// Faces as a file has them: corners by index, nothing checked yet but the indices.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mesh/mesh_file.h"

namespace tyndall::mesh {

struct SoupFace {
    std::vector<std::uint32_t> corners;  // into FaceSoup::points
    std::uint32_t group = 0;             // into FaceSoup::groups
};

struct FaceSoup {
    std::vector<Point> points;  // [m]
    std::vector<SoupFace> faces;
    std::vector<std::string> groups{""};
};

// Reads Wavefront OBJ text; `name` is the file's, for messages "name:line: …".
// Groups are those of `g`, or of `o` if no `g` names one; faces before the first have the name "".
// Everything that is no vertex, face or group is passed over; a line that OBJ does not know is an
// error.
FaceSoup read_obj(const std::string& text, const std::string& name);

// What the head of a PLY, STL or OFF file promises.
struct FileCounts {
    std::optional<std::size_t> vertices, faces;
    bool binary = false;
};

// Checks, before a reader that trusts its input sees it, that the file is of the format its
// extension
// ("ply", "stl", "off") says, holds as much as its head promises, and that text faces have indices
// in range. Throws InputError, "name:line: …" where the file is text.
FileCounts check_mesh_text(const std::string& text, const std::string& name,
                           const std::string& extension);

// Purpose: weld points nearer than `tolerance` × the size of all, drop faces without area and those
//   that are there twice, cut those that are not planar into triangles (ear clipping).
// Empty groups are left out. Cost: O(n log n), O(k²) for a non-planar polygon of k corners.
MeshFile mend(FaceSoup soup, double tolerance = 1e-6);

}  // namespace tyndall::mesh
