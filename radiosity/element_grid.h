// The leaves of a solution as an unstructured grid with all that they hold, for files.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "radiosity/solution.h"

namespace tyndall::radiosity {

inline constexpr std::uint8_t vtk_triangle = 5, vtk_tetra = 10;  // VTK's cell types

// What every cell has: `components` numbers.
struct CellColumn {
    std::string name;
    std::size_t components = 1;
    std::variant<std::vector<double>, std::vector<float>, std::vector<std::int32_t>,
                 std::vector<std::int64_t>, std::vector<std::uint8_t>>
        values;  // `components` of the first cell, of the second, and so on
};

struct ElementGrid {
    std::size_t bands = 1;
    std::vector<double> points;              // x, y, z of the corners, a set for each cell [m]
    std::vector<std::int64_t> connectivity;  // points of the cells, one after the other
    std::vector<std::int64_t> offsets;       // where each cell's points begin; the end
    std::vector<std::uint8_t> types;         // triangles (patches) first, then tetrahedra
    std::vector<double> radiance;            // x at the points, a number a band [W/m^2/sr]
    std::vector<CellColumn> cells;           // by the names and units of docs/guide/04-outputs.md
    std::vector<std::string> names;  // that the column `name_id` points to: sides, then media

    // Triangles and tetrahedra together; three and four points of each.
    std::size_t cell_count() const { return types.size(); }
    // Points of all cells, those of neighbours twice.
    std::size_t point_count() const { return points.size() / 3; }
};

// Purpose: the grid. Triangles run counter-clockwise seen from the side that they are of.
// Cost: some 300 bytes a leaf and band.
ElementGrid element_grid(const Solution& solution);

}  // namespace tyndall::radiosity
