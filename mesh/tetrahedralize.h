// Tetrahedra for a conforming complex, by TetGen in a child process.
#pragma once

#include <cstddef>
#include <filesystem>

#include "mesh/base_mesh.h"
#include "mesh/conform.h"

namespace tyndall::mesh {

struct TetrahedralizeOptions {
    double hull_margin = 0.05;   // the hull is the bounding box grown by this × its diagonal [-]
    double max_seconds = 120.0;  // for TetGen's process [s]
    std::size_t max_bytes = 4ull << 30;  // address space of TetGen's process [byte]
    std::filesystem::path
        worker;  // program that runs TetGen; empty: found beside this program, or installed
};

// Purpose: fill the hull (bounding box + margin) with tetrahedra whose faces hold every facet of
//   the complex. TetGen is tried with mild quality first (facets may be split), then without.
// Checked: tets > 0, total volume, area of every source facet, orientation.
// `polygons` are those the complex was made from; they give names to the errors.
// Errors: InputError that names the surfaces and where, if TetGen cannot mesh the complex, runs out
//   of time or memory, or its result fails the checks.
BaseMesh tetrahedralize(const ConformingComplex& complex, std::span<const Polygon> polygons,
                        const TetrahedralizeOptions& options = {});

}  // namespace tyndall::mesh
