#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

#include "mesh/input_error.h"
#include "mesh/tet_file_lines.h"

namespace tyndall::mesh {
namespace {

// The element types of Gmsh that its meshers write.
struct ElementType {
    std::uint64_t number;
    int dimension;
    std::size_t nodes;
    const char* name;
};
constexpr std::array<ElementType, 33> element_types{{
    {15, 0, 1, "point"},        {1, 1, 2, "line"},          {8, 1, 3, "line"},
    {26, 1, 4, "line"},         {27, 1, 5, "line"},         {28, 1, 6, "line"},
    {2, 2, 3, "triangle"},      {9, 2, 6, "triangle"},      {20, 2, 9, "triangle"},
    {21, 2, 10, "triangle"},    {22, 2, 12, "triangle"},    {23, 2, 15, "triangle"},
    {24, 2, 15, "triangle"},    {25, 2, 21, "triangle"},    {3, 2, 4, "quadrangle"},
    {10, 2, 9, "quadrangle"},   {16, 2, 8, "quadrangle"},   {36, 2, 16, "quadrangle"},
    {4, 3, 4, "tetrahedron"},   {11, 3, 10, "tetrahedron"}, {29, 3, 20, "tetrahedron"},
    {30, 3, 35, "tetrahedron"}, {31, 3, 56, "tetrahedron"}, {5, 3, 8, "hexahedron"},
    {12, 3, 27, "hexahedron"},  {17, 3, 20, "hexahedron"},  {92, 3, 64, "hexahedron"},
    {6, 3, 6, "prism"},         {13, 3, 18, "prism"},       {18, 3, 15, "prism"},
    {7, 3, 5, "pyramid"},       {14, 3, 14, "pyramid"},     {19, 3, 13, "pyramid"},
}};

class GmshReader {
  public:
    GmshReader(std::string_view text, const std::string& name) : lines_(text, name, "//") {
        file_.name = name;
    }

    TetFile read() {
        head();
        while (lines_.next()) {
            const std::string section(lines_.words()[0]);
            if (!section.starts_with('$'))
                lines_.fail(
                    fmt::format("\"{}\" stands where a section is to begin. Is the count "
                                "of the section before too small?",
                                section.substr(0, 40)));
            if (section == "$Nodes" || section == "$ParametricNodes")
                nodes();
            else if (section == "$Elements")
                elements();
            else
                pass_over(section);
        }
        if (!has_nodes_) lines_.fail("the file has no $Nodes. Is it truncated?");
        if (!has_elements_) lines_.fail("the file has no $Elements. Is it truncated?");
        if (higher_order_ > 0)
            file_.notes.push_back(fmt::format(
                "of {} second-order (or higher) tetrahedra only the corners are used: edges are "
                "straight",
                higher_order_));
        file_.points = nodes_.take_points();
        return std::move(file_);
    }

  private:
    void head() {
        if (!lines_.next()) lines_.fail("the file is empty. Export the mesh again.");
        if (lines_.words()[0] != "$MeshFormat")
            lines_.fail("an MSH file of Gmsh begins with $MeshFormat. Is the file one?");
        lines_.expect("its format");
        const std::string_view version = lines_.words()[0];
        four_ = version == "4.1";
        const bool two = version == "2" || version == "2.0" || version == "2.1" || version == "2.2";
        if (!four_ && !two)
            lines_.fail(
                fmt::format("MSH version \"{}\" is not read. Export the mesh as version "
                            "4.1 or 2.2 (Gmsh: Mesh.MshFileVersion).",
                            version.substr(0, 40)));
        if (lines_.whole(1, "the file type") != 0)
            lines_.fail(
                "the file is binary, which is not read. Export it as text (Gmsh: "
                "Mesh.Binary = 0).");
        lines_.expect("$EndMeshFormat");
        end_of("$MeshFormat");
    }

    // The current line must end the section.
    void end_of(const std::string& section) {
        const std::string wanted = "$End" + section.substr(1);
        if (lines_.words()[0] != wanted)
            lines_.fail(fmt::format("\"{}\" stands where {} is expected. Is a count too small?",
                                    lines_.words()[0].substr(0, 40), wanted));
    }

    void pass_over(const std::string& section) {
        const std::string end = "$End" + section.substr(1);
        do lines_.expect(end);
        while (lines_.words()[0] != end);
    }

    // An item's line, which may not be the section's end.
    void item(const char* what, std::size_t done, std::size_t all) {
        lines_.expect(fmt::format("{} {} of {}", what, done + 1, all));
        if (lines_.words()[0].starts_with('$'))
            lines_.fail(
                fmt::format("{} stands where {} {} of {} is expected. Is a count too "
                            "large, or the file truncated?",
                            lines_.words()[0].substr(0, 40), what, done + 1, all));
    }

    Point coordinates(std::size_t first) const {
        return {lines_.coordinate(first), lines_.coordinate(first + 1),
                lines_.coordinate(first + 2)};
    }

    void nodes() {
        const std::string section(lines_.words()[0]);
        if (has_nodes_) lines_.fail("there are two sections of nodes. Keep one.");
        has_nodes_ = true;
        lines_.expect("the count of nodes");
        if (four_)
            node_blocks();
        else {
            const auto count = lines_.count(0, "the count of nodes", 8);
            for (std::size_t i = 0; i < count; ++i) {
                item("node", i, count);
                nodes_.add(lines_.whole(0, "a node's number"), coordinates(1), lines_);
            }
        }
        nodes_.sort(lines_);
        lines_.expect("$EndNodes");
        end_of(section);
    }

    void node_blocks() {
        const auto blocks = lines_.count(0, "the count of node blocks", 8);
        const auto total = lines_.count(1, "the count of nodes", 8);
        std::vector<std::uint64_t> numbers;
        for (std::size_t b = 0; b < blocks; ++b) {
            item("node block", b, blocks);
            const auto count = lines_.count(3, "the count of nodes in this block", 8);
            numbers.clear();
            for (std::size_t i = 0; i < count; ++i) {
                item("number of node", i, count);
                numbers.push_back(lines_.whole(0, "a node's number"));
            }
            for (std::size_t i = 0; i < count; ++i) {
                item("coordinates of node", i, count);
                nodes_.add(numbers[i], coordinates(0), lines_);
            }
        }
        if (nodes_.size() != total)
            lines_.fail(fmt::format("{} nodes are there, {} were announced. Is the file damaged?",
                                    nodes_.size(), total));
    }

    void elements() {
        if (!has_nodes_) lines_.fail("$Elements stands before $Nodes. Export the file again.");
        if (has_elements_) lines_.fail("there are two sections of elements. Keep one.");
        has_elements_ = true;
        lines_.expect("the count of elements");
        if (four_)
            element_blocks();
        else {
            const auto count = lines_.count(0, "the count of elements", 6);
            for (std::size_t i = 0; i < count; ++i) {
                item("element", i, count);
                const auto& type = known(lines_.whole(1, "an element's type"));
                const auto tags = lines_.count(2, "the count of an element's tags", 1);
                element(type, 3 + tags);
            }
        }
        lines_.expect("$EndElements");
        end_of("$Elements");
    }

    void element_blocks() {
        const auto blocks = lines_.count(0, "the count of element blocks", 6);
        for (std::size_t b = 0; b < blocks; ++b) {
            item("element block", b, blocks);
            const auto& type = known(lines_.whole(2, "an element's type"));
            const auto count = lines_.count(3, "the count of elements in this block", 4);
            for (std::size_t i = 0; i < count; ++i) {
                item("element", i, count);
                element(type, 1);
            }
        }
    }

    const ElementType& known(std::uint64_t number) const {
        for (const ElementType& type : element_types) {
            if (type.number != number) continue;
            if (type.dimension == 3 && std::string_view(type.name) != "tetrahedron")
                lines_.fail(fmt::format(
                    "the mesh has a {} (Gmsh's element type {}); all its volumes must be "
                    "tetrahedra. Mesh without recombination or extruded layers.",
                    type.name, number));
            return type;
        }
        lines_.fail(
            fmt::format("element type {} is not known. Export tetrahedra of first order.", number));
    }

    // The element of the current line, whose first corner is at `first`.
    void element(const ElementType& type, std::size_t first) {
        if (type.dimension != 3) return;
        FileTet tet{{}, lines_.whole(0, "an element's number"), lines_.line()};
        if (lines_.words().size() != first + type.nodes)
            lines_.fail(fmt::format(
                "tetrahedron {} has {} nodes instead of {}. Correct the file; "
                "is it truncated?",
                tet.number, lines_.words().size() - std::min(lines_.words().size(), first),
                type.nodes));
        for (std::size_t k = 0; k < 4; ++k)
            tet.corners[k] =
                nodes_.index(lines_.whole(first + k, "a node's number"), tet.number, lines_);
        higher_order_ += type.nodes > 4;
        file_.tets.push_back(tet);
    }

    TetFileLines lines_;
    TetFile file_;
    FileNodes nodes_;
    std::size_t higher_order_ = 0;
    bool four_ = false, has_nodes_ = false, has_elements_ = false;
};

}  // namespace

TetFile read_gmsh(std::string_view text, const std::string& name) {
    return GmshReader(text, name).read();
}

}  // namespace tyndall::mesh
