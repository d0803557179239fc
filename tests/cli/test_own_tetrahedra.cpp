// solve.start = "mesh": good files are meshed, broken ones refused with exit code 1 and the place.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "cli/scene_file.h"
#include "mesh/input_error.h"
#include "mesh/tet_file.h"
#include "radiosity/enclosure.h"
#include "support/catch.h"
#include "support/program.h"

using namespace tyndall;
namespace fs = std::filesystem;

namespace {

const fs::path meshes = fs::path(TYNDALL_SOURCE_DIR) / "tests/meshes";

test::Outcome check(const fs::path& mesh) {
    const test::Workplace place("own");
    return place.run("check '" + (meshes / "room.toml").string() +
                     "' --set 'solve.mesh=" + mesh.string() + "'");
}

// File, the line it names (0: none), part of what is said.
struct Broken {
    const char* file;
    int line;
    const char* part;
};
const Broken broken[] = {
    {"empty.msh", 1, "the file is empty"},
    {"not_msh.msh", 1, "begins with $MeshFormat"},
    {"version_4_0.msh", 2, "MSH version \"4\" is not read"},
    {"binary.msh", 2, "the file is binary"},
    {"nan.msh", 8, "not finite"},
    {"word.msh", 8, "\"x1.5\" is not a number"},
    {"node_twice.msh", 10, "node 4 is there twice"},
    {"unknown_node.msh", 14, "tetrahedron 1 has the corner 9"},
    {"truncated_nodes.msh", 8, "ends before node 4 of 5"},
    {"truncated_elements.msh", 14, "ends before element 2 of 3"},
    {"count_large.msh", 5, "more than fits into the file"},
    {"count_small.msh", 9, "$EndNodes is expected"},
    {"hexahedron.msh", 15, "a hexahedron"},
    {"prism.msh", 14, "a prism"},
    {"unknown_type.msh", 14, "element type 140 is not known"},
    {"few_corners.msh", 14, "tetrahedron 1 has 3 nodes instead of 4"},
    {"flat.msh", 14, "tetrahedron 8 near [0, 0, 0] is flat"},
    {"surface_only.msh", 0, "there is no tetrahedron"},
    {"no_elements.msh", 11, "no $Elements"},
    {"overlap.msh", 15, "tetrahedron 1 overlaps tetrahedron 2"},
    {"three_on_face.msh", 16, "tetrahedron 1 overlaps tetrahedron 3"},
    {"one_tetrahedron.msh", 0, "do not follow surface \"partition"},
    {"lifted_node.msh", 0, "do not follow surface \"room.floor"},
    {"blocks.msh", 14, "coordinates of node 4 of 4"},
    {"tets.vtu", 0, "\".vtu\" is no extension"},
    {"alone.ele", 0, "alone.node"},
    {"index.ele", 2, "tetrahedron 0 has the corner 4"},
    {"short.node", 3, "fewer than three coordinates"},
    {"plane.node", 1, "the nodes have 2 coordinates"},
    {"more.ele", 3, "more than the 1 tetrahedra announced"},
};

}  // namespace

TEST_CASE("Broken files of tetrahedra are refused with their name and line") {
    const fs::path folder = fs::path(TYNDALL_SOURCE_DIR) / "tests/broken/tetrahedra";
    std::set<std::string> tested;
    for (const Broken& b : broken) {
        const test::Outcome outcome = check(folder / b.file);
        INFO(b.file << ": " << outcome.err);
        CHECK(outcome.code == 1);
        CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
        const std::string place = b.line > 0
                                      ? std::string(b.file) + ":" + std::to_string(b.line) + ": "
                                      : fs::path(b.file).stem().string();
        CHECK(outcome.err.find(place) != std::string::npos);
        CHECK(outcome.err.find(b.part) != std::string::npos);
        tested.insert(fs::path(b.file).stem().string());
    }
    for (const auto& entry : fs::directory_iterator(folder))
        CHECK(tested.count(entry.path().stem().string()) == 1);
}

TEST_CASE("Meshes that leave out a surface are refused with its name") {
    const test::Outcome partition = check("no_partition.msh"), lamp = check("no_lamp.msh");
    CHECK(partition.code == 1);
    CHECK(partition.err.find("no_partition.msh do not follow surface \"partition") !=
          std::string::npos);
    CHECK(lamp.code == 1);
    CHECK(lamp.err.find("do not follow surface \"lamp") != std::string::npos);
}

TEST_CASE("Meshes from Gmsh and TetGen make a sound scene with the areas and volumes of it") {
    for (const char* name : {"room41.msh", "room22.msh", "room.1.ele", "room.1.node"}) {
        INFO(name);
        const auto file = cli::read_scene_file(meshes / "room.toml",
                                               {std::string("solve.mesh=\"") + name + "\""});
        const auto e = radiosity::make_enclosure(file.scene, {.tetrahedra = file.tetrahedra});
        CHECK_FALSE(e.open);
        CHECK(e.warnings.empty());
        double area = 0.0, volume = 0.0;
        for (const auto& side : e.sides) area += side.area;
        for (std::size_t t = 0; t < e.mesh.tets.size(); ++t)
            if (e.medium_of(mesh::TetId(t)) != radiosity::none)
                volume += mesh::volume(e.mesh, mesh::TetId(t));
        CHECK(area == Approx(13.0 + 2.1).epsilon(1e-9));
        CHECK(volume == Approx(3.0).epsilon(1e-9));
    }
}

TEST_CASE("An open scene: a mesh of the room alone, and one that fills the air around it") {
    const auto read = [](const char* name) {
        return cli::read_scene_file(meshes / "window.toml",
                                    {std::string("solve.mesh=\"") + name + "\""});
    };
    const auto room = read("window.msh"), air = read("air.msh");
    const auto part = radiosity::make_enclosure(room.scene, {.tetrahedra = room.tetrahedra});
    CHECK(part.open);
    REQUIRE(part.warnings.size() == 1);
    CHECK(part.warnings[0].find("m3 in which light can be without tetrahedra") !=
          std::string::npos);
    const auto whole = radiosity::make_enclosure(air.scene, {.tetrahedra = air.tetrahedra});
    CHECK(whole.open);
    CHECK(whole.warnings.empty());
    CHECK(whole.mesh.hull_min == mesh::Point(-0.5, -0.5, -0.5));  // the file's own box
    const auto facets = mesh::read_tet_file(air.tetrahedra).tets.size();
    CHECK(whole.mesh.tets.size() == facets);
}

TEST_CASE("solve.mesh is needed for start = \"mesh\", must be there, and idle otherwise") {
    const auto message = [](std::vector<std::string> overrides) -> std::string {
        try {
            const auto file = cli::read_scene_file(meshes / "room.toml", overrides);
            return file.notes.empty() ? "" : file.notes.back();
        } catch (const mesh::InputError& error) {
            return error.what();
        }
    };
    CHECK(message({"solve.mesh=\"\""}).find("no file is given") != std::string::npos);
    CHECK(message({"solve.mesh=\"none.msh\""}).find("there is no file") != std::string::npos);
    CHECK(message({"solve.start=\"base\""}).find("solve.mesh is not used") != std::string::npos);
    CHECK(message({}) == "");
}
