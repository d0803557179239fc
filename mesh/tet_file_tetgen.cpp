#include <fmt/format.h>

#include "mesh/tet_file_lines.h"

namespace tyndall::mesh {
namespace {

FileNodes read_nodes(TetFileLines& lines) {
    lines.expect("its first line (count of nodes, 3, attributes, markers)");
    const auto count = lines.count(0, "the count of nodes", 8);
    if (count == 0)
        lines.fail(
            "the file holds no nodes. Give the .node file that TetGen wrote beside the "
            ".ele file.");
    if (const auto dimension = lines.whole(1, "the dimension"); dimension != 3)
        lines.fail(
            fmt::format("the nodes have {} coordinates; 3 are expected. Is the file "
                        "Triangle's?",
                        dimension));
    FileNodes nodes;
    for (std::size_t i = 0; i < count; ++i) {
        lines.expect(fmt::format("node {} of {}", i + 1, count));
        nodes.add(lines.whole(0, "a node's number"),
                  {lines.coordinate(1), lines.coordinate(2), lines.coordinate(3)}, lines);
    }
    nodes.sort(lines);
    return nodes;
}

}  // namespace

TetFile read_tetgen(std::string_view node_text, const std::string& node_name,
                    std::string_view tet_text, const std::string& tet_name) {
    TetFileLines node_lines(node_text, node_name, "#");
    FileNodes nodes = read_nodes(node_lines);
    TetFile file;
    file.name = tet_name;
    TetFileLines lines(tet_text, tet_name, "#");
    lines.expect("its first line (count of tetrahedra, nodes of each, attributes)");
    const auto count = lines.count(0, "the count of tetrahedra", 8);
    const auto corners = lines.whole(1, "the nodes of a tetrahedron");
    if (corners != 4 && corners != 10)
        lines.fail(
            fmt::format("the tetrahedra have {} nodes; 4 or 10 are expected. Is the file "
                        "Triangle's?",
                        corners));
    for (std::size_t i = 0; i < count; ++i) {
        lines.expect(fmt::format("tetrahedron {} of {}", i + 1, count));
        FileTet tet{{}, lines.whole(0, "a tetrahedron's number"), lines.line()};
        for (std::size_t k = 0; k < 4; ++k)
            tet.corners[k] = nodes.index(lines.whole(1 + k, "a node's number"), tet.number, lines);
        file.tets.push_back(tet);
    }
    if (lines.next())
        lines.fail(fmt::format("there is more than the {} tetrahedra announced. Correct the count.",
                               count));
    if (corners == 10)
        file.notes.push_back(fmt::format(
            "of {} second-order tetrahedra only the corners are used: edges are straight", count));
    file.points = nodes.take_points();
    return file;
}

}  // namespace tyndall::mesh
