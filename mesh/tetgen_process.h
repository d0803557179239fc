// TetGen in a child process: one call, one result or one way of dying.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "mesh/types.h"

namespace tyndall::mesh::tetgen {

// Facets carry markers >= 1.
struct Input {
    std::vector<Point> points;  // [m]
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::int32_t> triangle_markers;
    std::vector<std::array<std::uint32_t, 4>> quads;
    std::vector<std::int32_t> quad_markers;
};

struct Output {
    std::vector<Point> points;
    std::vector<std::array<std::uint32_t, 4>> tets;
    std::vector<std::array<std::uint32_t, 3>> faces;
    std::vector<std::int32_t> face_markers;
};

enum class Outcome { done, refused, died, out_of_time, out_of_memory };

struct Run {
    Outcome outcome = Outcome::done;
    std::string message;  // how it ended, with the end of what TetGen said
    Output output;        // if done
};

struct Limits {
    double seconds;      // by the clock on the wall [s]
    double cpu_seconds;  // of the processor, rounded up [s]
    std::size_t bytes;   // of address space
};

// The worker program: `wanted` if not empty, else tyndall-tetgen beside the running program, in the
// build folder or installed. Throws InputError that lists where it was looked for.
std::filesystem::path find_worker(const std::filesystem::path& wanted);

// Purpose: TetGen with the given switches. Leaves neither process nor file behind, whatever
// happens. Errors: std::runtime_error if the system gives neither temporary file nor process.
Run run(const std::filesystem::path& worker, const std::string& switches, const Input& input,
        const Limits& limits);

}  // namespace tyndall::mesh::tetgen
