#include "mesh/tet_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>

#include "mesh/file_bytes.h"
#include "mesh/input_error.h"
#include "mesh/point_weld.h"
#include "mesh/tet_file_lines.h"

namespace tyndall::mesh {
namespace {

constexpr std::uint32_t unused = 0xffffffffu;

std::string lower_extension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

TetFile read_by_extension(const std::filesystem::path& path) {
    const std::string extension = lower_extension(path);
    if (extension == ".msh") {
        const std::string text = read_file(path);
        return read_gmsh(text, path.string());
    }
    if (extension == ".ele" || extension == ".node") {
        auto nodes = path, tets = path;
        if (extension == ".ele")
            nodes.replace_extension(".node");
        else
            tets.replace_extension(".ele");
        const std::string node_text = read_file(nodes), tet_text = read_file(tets);
        return read_tetgen(node_text, nodes.string(), tet_text, tets.string());
    }
    throw InputError(
        fmt::format("{}: \"{}\" is no extension of a file of tetrahedra. Give Gmsh's "
                    ".msh, or TetGen's .ele or .node.",
                    path.string(), path.extension().string()));
}

double mesh_size(const TetFile& file) {
    Point low = file.points[file.tets[0].corners[0]], high = low;
    for (const FileTet& tet : file.tets)
        for (const auto i : tet.corners) {
            low = glm::min(low, file.points[i]);
            high = glm::max(high, file.points[i]);
        }
    return glm::distance(low, high);
}

// Keeps the points that tets use, those at one place once.
void weld(TetFile& file) {
    const double size = mesh_size(file);
    if (!(size > 0.0))
        throw InputError(
            fmt::format("{}: all nodes are at one place. Correct the file.", file.name));
    PointWeld welded(1e-9 * size);
    std::vector<std::uint32_t> numbers(file.points.size(), unused);
    std::size_t used = 0;
    for (FileTet& tet : file.tets)
        for (auto& i : tet.corners) {
            if (numbers[i] == unused) {
                numbers[i] = welded.number(file.points[i]);
                ++used;
            }
            i = numbers[i];
        }
    if (used < file.points.size())
        file.notes.push_back(fmt::format("dropped {} of {} nodes, which no tetrahedron has",
                                         file.points.size() - used, file.points.size()));
    if (welded.points().size() < used)
        file.notes.push_back(fmt::format("welded {} of {} nodes with others at the same place",
                                         used - welded.points().size(), used));
    file.points = welded.points();
}

void orient(TetFile& file) {
    std::size_t turned = 0;
    for (std::size_t t = 0; t < file.tets.size(); ++t) {
        auto& c = file.tets[t].corners;
        std::array<Point, 4> p;
        for (int k = 0; k < 4; ++k) p[k] = file.points[c[k]];
        const double six = glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]);
        double longest = 0.0;
        for (int j = 0; j < 4; ++j)
            for (int k = 0; k < j; ++k) longest = std::max(longest, glm::distance(p[j], p[k]));
        if (!(std::abs(six) > flat_tet * longest * longest * longest))
            throw InputError(fmt::format(
                "{} near [{:.6g}, {:.6g}, {:.6g}] is flat: its volume is {:.3g} m3 with edges of "
                "{:.3g} m. Remove it or move its corners (Gmsh: Mesh.Optimize; TetGen: -q).",
                file.place(t), p[0].x, p[0].y, p[0].z, six / 6.0, longest));
        if (six > 0.0) continue;
        std::swap(c[2], c[3]);
        ++turned;
    }
    if (turned > 0)
        file.notes.push_back(
            fmt::format("turned {} of {} tetrahedra, whose corners ran the other "
                        "way round",
                        turned, file.tets.size()));
}

void drop_repeated(TetFile& file) {
    std::vector<std::array<std::uint32_t, 4>> keys;
    for (const FileTet& tet : file.tets) {
        keys.push_back(tet.corners);
        std::sort(keys.back().begin(), keys.back().end());
    }
    std::vector<std::size_t> order(keys.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return keys[a] < keys[b]; });
    std::vector<bool> repeated(keys.size());
    std::size_t count = 0;
    for (std::size_t i = 1; i < order.size(); ++i)
        if (keys[order[i]] == keys[order[i - 1]]) {
            repeated[order[i]] = true;
            ++count;
        }
    if (count == 0) return;
    std::size_t kept = 0;
    for (std::size_t t = 0; t < file.tets.size(); ++t)
        if (!repeated[t]) file.tets[kept++] = file.tets[t];
    file.notes.push_back(
        fmt::format("dropped {} of {} tetrahedra, which were there twice", count, keys.size()));
    file.tets.resize(kept);
}

}  // namespace

std::string TetFile::place(std::size_t tet) const {
    return fmt::format("{}:{}: tetrahedron {}", name, tets[tet].line, tets[tet].number);
}

TetFile read_tet_file(const std::filesystem::path& path) {
    TetFile file = read_by_extension(path);
    if (file.tets.empty())
        throw InputError(
            fmt::format("{}: there is no tetrahedron in it. Mesh the volume, not only "
                        "its surface (Gmsh: -3), and save all elements.",
                        file.name));
    weld(file);
    orient(file);
    drop_repeated(file);
    return file;
}

}  // namespace tyndall::mesh
