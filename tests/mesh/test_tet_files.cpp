// Files of tetrahedra: read, mended, and made the base mesh of a scene.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>

#include "mesh/conform.h"
#include "mesh/input_error.h"
#include "mesh/shapes.h"
#include "mesh/tet_file.h"
#include "mesh/tet_file_fit.h"
#include "support/catch.h"

using namespace tyndall::mesh;
namespace fs = std::filesystem;

namespace {

struct Folder {
    fs::path path = fs::temp_directory_path() / ("tyndall_tets_" + std::to_string(::getpid()));
    Folder() { fs::create_directories(path); }
    ~Folder() {
        std::error_code ignored;
        fs::remove_all(path, ignored);
    }
    fs::path write(const std::string& name, const std::string& text) const {
        std::ofstream(path / name, std::ios::binary) << text;
        return path / name;
    }
};

// The unit cube about its main diagonal, corner k at (k & 1, k & 2, k & 4): six tets, with numbers
// from 1.
const std::string corners_22 =
    "1 0 0 0\n2 1 0 0\n3 0 1 0\n4 1 1 0\n5 0 0 1\n6 1 0 1\n7 0 1 1\n8 1 1 1\n";
const std::vector<std::array<int, 4>> cube_tets{{1, 2, 4, 8}, {1, 4, 3, 8}, {1, 3, 7, 8},
                                                {1, 7, 5, 8}, {1, 5, 6, 8}, {1, 6, 2, 8}};

std::string elements_22(const std::vector<std::array<int, 4>>& tets) {
    std::string text = std::to_string(tets.size()) + "\n";
    for (std::size_t t = 0; t < tets.size(); ++t) {
        text += std::to_string(t + 1) + " 4 2 7 1";
        for (const int c : tets[t]) text.append(" ").append(std::to_string(c));
        text += "\n";
    }
    return text;
}

std::string msh_22(const std::string& nodes, std::size_t count, const std::string& elements) {
    return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 7 \"haze\"\n"
           "$EndPhysicalNames\n$Nodes\n" +
           std::to_string(count) + "\n" + nodes + "$EndNodes\n$Elements\n" + elements +
           "$EndElements\n";
}

double volume_of(const TetFile& file) {
    double sum = 0.0;
    for (const auto& tet : file.tets) {
        const auto p = [&](int k) { return file.points[tet.corners[k]]; };
        const double six = glm::dot(glm::cross(p(1) - p(0), p(2) - p(0)), p(3) - p(0));
        CHECK(six > 0.0);
        sum += six / 6.0;
    }
    return sum;
}

double volume_of(const BaseMesh& mesh) {
    double sum = 0.0;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) sum += volume(mesh, TetId(t));
    return sum;
}

std::vector<Polygon> polygons_of(const std::vector<Face>& faces, const std::string& name) {
    std::vector<Polygon> list;
    for (const Face& face : faces)
        for (Polygon polygon : face.polygons) {
            polygon.name = name + "." + face.name;
            list.push_back(polygon);
        }
    return list;
}

std::string trouble_of(const TetFile& file, const std::vector<Polygon>& polygons) {
    try {
        fit_tetrahedra(file, conform(polygons), polygons);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

bool has_note(const TetFile& file, const std::string& part) {
    for (const auto& note : file.notes)
        if (note.find(part) != std::string::npos) return true;
    return false;
}

}  // namespace

TEST_CASE("The same tetrahedra from MSH 2.2, MSH 4.1 and TetGen files") {
    const Folder folder;
    const auto two = folder.write("cube.msh", msh_22(corners_22, 8, elements_22(cube_tets)));
    std::string blocks =
        "$MeshFormat\r\n4.1 0 8\r\n$EndMeshFormat\n$Nodes\n2 8 1 8\n0 1 0 3\n1\n2\n3\n0 0 0\n1 0 "
        "0\n0 1 0\n3 1 0 5\n4\n5\n6\n7\n8\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n$EndNodes\n"
        "$Elements\n2 7 1 7\n2 1 2 1\n1 1 2 4\n3 1 4 6\n";
    std::string ele = "# zero-based\n6 4 0\n";
    for (std::size_t t = 0; t < 6; ++t) {
        blocks += std::to_string(t + 2);
        ele += std::to_string(t);
        for (const int c : cube_tets[t]) {
            blocks.append(" ").append(std::to_string(c));
            ele.append(" ").append(std::to_string(c - 1));
        }
        blocks += "\n";
        ele += "\n";
    }
    const auto four = folder.write("cube4.msh", blocks + "$EndElements\n");
    folder.write("cube.node",
                 "8 3 0 1\n0 0 0 0 1\n1 1 0 0 1\n2 0 1 0 1\n3 1 1 0 1\n4 0 0 1 1\n5 1 0 1 1\n6 0 1 "
                 "1 1\n7 1 1 1 1\n");
    folder.write("cube.ele", ele);
    const TetFile first = read_tet_file(two);
    CHECK(first.notes.empty());
    CHECK(first.tets.size() == 6);
    CHECK(volume_of(first) == Approx(1.0).epsilon(1e-15));
    CHECK(first.place(2) == two.string() + ":23: tetrahedron 3");
    for (const auto& path : {four, folder.path / "cube.ele", folder.path / "cube.node"}) {
        INFO(path);
        const TetFile other = read_tet_file(path);
        CHECK(other.points == first.points);
        REQUIRE(other.tets.size() == first.tets.size());
        for (std::size_t t = 0; t < 6; ++t) CHECK(other.tets[t].corners == first.tets[t].corners);
    }
}

TEST_CASE("What is mended in a file of tetrahedra is said") {
    const Folder folder;
    auto tets = cube_tets;
    std::swap(tets[1][2], tets[1][3]);  // runs the other way
    tets.push_back(tets[0]);            // there twice
    tets[3][0] = 9;                     // the same place as 1
    const auto file = read_tet_file(folder.write(
        "cube.msh", msh_22(corners_22 + "9 1e-12 0 0\n10 5 5 5\n", 10, elements_22(tets))));
    CHECK(file.tets.size() == 6);
    CHECK(file.points.size() == 8);
    CHECK(volume_of(file) == Approx(1.0).epsilon(1e-11));
    CHECK(file.notes.size() == 4);
    CHECK(has_note(file, "turned 1 of 7"));
    CHECK(has_note(file, "dropped 1 of 7 tetrahedra"));
    CHECK(has_note(file, "welded 1 of 9 nodes"));
    CHECK(has_note(file, "dropped 1 of 10 nodes"));
}

TEST_CASE("Of second-order tetrahedra the corners are used") {
    const Folder folder;
    const auto file = read_tet_file(folder.write(
        "one.msh",
        msh_22("1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 .5 0 0\n6 .5 .5 0\n7 0 .5 0\n8 0 0 .5\n9 0 "
               ".5 .5\n10 .5 0 .5\n",
               10, "1\n1 11 2 0 1 1 2 3 4 5 6 7 8 9 10\n")));
    CHECK(file.tets.size() == 1);
    CHECK(file.points.size() == 4);
    CHECK(has_note(file, "second-order"));
}

TEST_CASE("A room's tetrahedra become the base mesh, and TetGen fills the rest of the hull") {
    const Folder folder;
    const auto polygons = polygons_of(room({0, 0, 0}, {1, 1, 1}), "room");
    const auto complex = conform(polygons);
    // Rounded as single precision rounds: nodes are moved onto the surfaces.
    auto file =
        read_tet_file(folder.write("cube.msh", msh_22(corners_22, 8, elements_22(cube_tets))));
    for (auto& p : file.points) p *= 1.0 + 1.2e-7;
    const auto fitted = fit_tetrahedra(file, complex, polygons);
    const auto& mesh = fitted.mesh;
    const auto extent = mesh.hull_max - mesh.hull_min;
    const double whole = extent.x * extent.y * extent.z;
    CHECK(volume_of(mesh) == Approx(whole).epsilon(1e-12));
    double area = 0.0, rest = 0.0;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
        area += tyndall::mesh::area(mesh, FacetId(f));
        CHECK(mesh.facets[f].tets[0].valid());
        CHECK(mesh.facets[f].tets[1].valid());
    }
    CHECK(mesh.facets.size() == 12);  // two on each face: what the file has, not what TetGen likes
    CHECK(area == Approx(6.0).epsilon(1e-12));
    for (const auto& tet : fitted.filled) rest += tet.volume;
    CHECK(rest == Approx(whole - 1.0).epsilon(1e-12));
    CHECK(mesh.tets.size() == 6 + fitted.filled.size());
    CHECK(mesh.region_count == 2);
    const auto inside = locate(mesh, {0.3, 0.2, 0.1});
    CHECK(mesh.regions[inside.value] != mesh.regions[locate(mesh, {-0.01, 0.5, 0.5}).value]);
}

TEST_CASE("Tetrahedra that fill a box around the scene are used as they are") {
    const Folder folder;
    const auto file =
        read_tet_file(folder.write("cube.msh", msh_22(corners_22, 8, elements_22(cube_tets))));
    // The triangle in the middle of the cube that tets 1 and 2 share, its corners cut off.
    const std::vector<Polygon> polygons{
        {{{0.2, 0.2, 0.3}, {0.4, 0.4, 0.5}, {0.2, 0.2, 0.5}}, Opacity::opaque, "flag"}};
    CHECK(trouble_of(file, polygons).find("do not follow surface \"flag\"") != std::string::npos);
    // Touching the hull: a margin is needed, so that TetGen fills one.
    const std::vector<Polygon> whole{{{{0, 0, 0}, {1, 1, 0}, {1, 1, 1}}, Opacity::opaque, "flag"}};
    const auto fitted = fit_tetrahedra(file, conform(whole), whole);
    CHECK(fitted.mesh.facets.size() == 1);
    CHECK(fitted.mesh.hull_min.x < -0.01);
    CHECK_FALSE(fitted.filled.empty());
}

TEST_CASE("Surfaces that the tetrahedra do not follow are named, with where and how much") {
    const Folder folder;
    const auto file =
        read_tet_file(folder.write("cube.msh", msh_22(corners_22, 8, elements_22(cube_tets))));
    auto polygons = polygons_of(room({0, 0, 0}, {1, 1, 1}), "room");
    polygons.push_back(
        {{{0.5, 0, 0}, {0.5, 1, 0}, {0.5, 1, 0.5}, {0.5, 0, 0.5}}, Opacity::opaque, "partition"});
    const auto message = trouble_of(file, polygons);
    INFO(message);
    CHECK(message.find("cube.msh") != std::string::npos);
    CHECK(message.find("surface \"partition\" near [0.5, ") != std::string::npos);
    CHECK(message.find("(0 m2 of 0.5 m2 covered)") != std::string::npos);
    // A room of which they fill only one half.
    CHECK(trouble_of(file, polygons_of(room({0, 0, 0}, {2, 1, 1}), "room"))
              .find("do not follow surface \"room.") != std::string::npos);
    // A surface outside is TetGen's, also where it shares an edge with the file's tets.
    polygons.pop_back();
    polygons.push_back({{{0, 0, 0}, {-1, 0, 0}, {-1, 1, 0}, {0, 1, 0}}, Opacity::opaque, "ledge"});
    CHECK(trouble_of(file, polygons) == "");
}

TEST_CASE("The files of real meshers read whole") {
    const fs::path folder = fs::path(TYNDALL_SOURCE_DIR) / "tests/meshes";
    for (const auto& [name, volume] : std::vector<std::pair<std::string, double>>{
             {"room22.msh", 3.0}, {"room41.msh", 3.0}, {"room.1.ele", 3.0}, {"air.msh", 15.0}}) {
        INFO(name);
        const TetFile file = read_tet_file(folder / name);
        CHECK(volume_of(file) == Approx(volume).epsilon(1e-9));
    }
}

TEST_CASE("A gap among the tetrahedra is filled, an overlap refused") {
    const Folder folder;
    const std::vector<Polygon> flag{{{{3, 0, 0}, {3, 1, 0}, {3, 1, 1}}, Opacity::opaque, "flag"}};
    auto tets = cube_tets;
    tets.erase(tets.begin() + 2);
    const auto gap =
        read_tet_file(folder.write("gap.msh", msh_22(corners_22, 8, elements_22(tets))));
    const auto fitted = fit_tetrahedra(gap, conform(flag), flag);
    const auto in_gap = locate(fitted.mesh, {0.1, 0.9, 0.5});
    REQUIRE(in_gap.valid());
    CHECK(volume(fitted.mesh, in_gap) == Approx(1.0 / 6.0).epsilon(1e-12));

    // A tet of its own nodes, across those of the cube.
    tets = cube_tets;
    tets.push_back({9, 10, 11, 12});
    const auto overlap = read_tet_file(folder.write(
        "overlap.msh",
        msh_22(corners_22 + "9 0.3 0.4 0.5\n10 2 0.4 0.5\n11 0.3 2 0.5\n12 0.3 0.4 2\n", 12,
               elements_22(tets))));
    const auto message = trouble_of(overlap, flag);
    INFO(message);
    CHECK(message.find("overlap.msh") != std::string::npos);
    CHECK(message.find("tetrahedron") != std::string::npos);
    CHECK(message.find("neither overlap nor cross a surface") != std::string::npos);
    // One wholly inside another is no crossing of faces, but of volumes.
    const auto nested = read_tet_file(folder.write(
        "nested.msh",
        msh_22(corners_22 + "9 0.8 0.3 0.1\n10 0.85 0.3 0.1\n11 0.8 0.35 0.1\n12 0.8 0.3 0.15\n",
               12, elements_22(tets))));
    CHECK(trouble_of(nested, flag).find("nested.msh") != std::string::npos);
}
