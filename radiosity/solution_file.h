// Solution files: HDF5, readable by ParaView, PyVista and VTK as VTKHDF, and by this program.
//
// /VTKHDF: an unstructured grid of the elements (triangles of patches, then tets of zones), points
//   doubled an element; cell data and the point data `radiance` as docs/guide/04-outputs.md lists
//   them.
// /tyndall: the enclosure, the forest and the fields, to the last bit; `format` counts its
// versions.
#pragma once

#include <filesystem>
#include <string>

#include "radiosity/solution.h"

namespace tyndall::radiosity {

// Raised whenever a file of before would be read as something else: what it holds, or the numbering
// of leaves that its arrays rely on, has changed. Files of linear functions are as they were before
// there were quadratic ones.
inline constexpr int solution_format = 3, linear_format = 2;

// Purpose: a solution as a file, which replaces an old one when it is complete. The same solution
//   gives the same bytes: what the computation cost is not in it.
// `attachments`: a JSON text that readers get back; what else belongs to the solution (cameras, …).
// Errors: mesh::InputError: no such folder, no permission, a full disk.
// Cost: about 400 bytes an element and band before compression, all of it in memory once.
void write_solution(const std::filesystem::path& path, const Solution& solution,
                    const std::string& attachments = "{}");

struct SolutionFile {
    Solution solution;  // costs in its report are 0
    std::string attachments;
};

// Purpose: what write_solution was given, all numbers to the last bit.
// Errors: mesh::InputError with the file's name: not there, not a solution, of a newer version, cut
//   short, or damaged: every index is checked before use.
SolutionFile read_solution(const std::filesystem::path& path);

}  // namespace tyndall::radiosity
