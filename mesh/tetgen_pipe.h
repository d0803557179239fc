// What passes between `tetrahedralize` and the program tyndall-tetgen, as plain bytes.
#pragma once

#include <cstdint>

namespace tyndall::mesh::tetgen_pipe {

// Arguments: SWITCHES SECONDS BYTES. Input on stdin:
//   Header, points (3 doubles each), triangles (3 uint32 corners each), their markers (int32 each),
//   quads (4 uint32 corners each), their markers.
// Output on stdout: Result, points (3 doubles each), tets (4 uint32 each), faces (3 uint32 each),
//   their markers (int32 each). TetGen's own messages go to stderr.
struct Header {
    std::uint64_t magic;
    std::uint64_t points, triangles, quads;
};

struct Result {
    std::uint64_t magic;
    std::uint64_t points, tets, faces;
};

inline constexpr std::uint64_t magic = 0x31544554444E5954ull;  // "TYNDTET1"

// Exit codes of the program besides 0.
enum Exit : int {
    bad_input = 64,  // the input ends early or is not of this format
    refused = 65,    // TetGen threw
    no_memory = 66,
};

}  // namespace tyndall::mesh::tetgen_pipe
