// Meshes and coloured surfaces, read back by our own readers. VTK, Gmsh and others read them in
// other_readers.py.
#include <cstring>
#include <filesystem>

#include "exports/coloured_surfaces.h"
#include "exports/gmsh_file.h"
#include "exports/vtu_file.h"
#include "mesh/file_bytes.h"
#include "mesh/input_error.h"
#include "mesh/mesh_file.h"
#include "mesh/tet_file.h"
#include "radiosity/adaptive.h"
#include "rich_room.h"
#include "support/catch.h"

using namespace tyndall;
namespace fs = std::filesystem;

namespace {

// A file that lives as long as this.
struct Written {
    fs::path path;

    Written(const std::string& name, const std::string& bytes)
        : path(fs::temp_directory_path() / ("tyndall_" + std::to_string(::getpid()) + name)) {
        mesh::write_file(path, bytes);
    }
    ~Written() { fs::remove(path); }
};

const radiosity::Solution& solution() {
    static const radiosity::Solution solved = radiosity::solve_adaptively(
        test::enclosed(test::slit_room()), {.error = 0.3,
                                            .start = radiosity::Start::base,
                                            .max_elements = 1500,
                                            .rays = 16,
                                            .gather_rays = 16});
    return solved;
}

double area_of(const std::vector<mesh::Polygon>& polygons) {
    double area = 0.0;
    for (const auto& polygon : polygons) {
        const auto& c = polygon.corners;
        glm::dvec3 sum(0.0);
        for (std::size_t k = 1; k + 1 < c.size(); ++k)
            sum += glm::cross(c[k] - c[0], c[k + 1] - c[0]);
        area += 0.5 * glm::length(sum);
    }
    return area;
}

}  // namespace

TEST_CASE("A mesh that Gmsh gets is the base mesh when it is read again", "[export]") {
    const auto scene = test::rich_room();
    const auto enclosure = radiosity::make_enclosure(scene);
    const Written file(".msh", exports::gmsh_file(enclosure).main);
    const auto read = mesh::read_tet_file(file.path);
    CHECK(read.notes.empty());
    CHECK(read.tets.size() == enclosure.mesh.tets.size());
    // To the last bit, whatever the order.
    const auto less = [](const mesh::Point& a, const mesh::Point& b) {
        return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    };
    auto ours = enclosure.mesh.points, theirs = read.points;
    std::ranges::sort(ours, less);
    std::ranges::sort(theirs, less);
    CHECK(ours == theirs);
    const auto again = radiosity::make_enclosure(scene, {.tetrahedra = file.path});
    REQUIRE(again.mesh.tets.size() == enclosure.mesh.tets.size());
    REQUIRE(again.sides.size() == enclosure.sides.size());
    for (const auto& side : enclosure.sides) {
        const auto same = std::ranges::find(again.sides, side.name, &radiosity::SurfaceSide::name);
        REQUIRE(same != again.sides.end());
        CHECK(same->area == Approx(side.area).epsilon(1e-12));
    }
}

TEST_CASE("Physical names are those of sides and media", "[export]") {
    const auto text = exports::gmsh_file(radiosity::make_enclosure(test::rich_room())).main;
    for (const char* name : {"2 1 \"", "\"room.floor\"", "\"screen\"", "\"openings\"", "\"haze\"",
                             "\"thick bank\"", "\"solid\"", "\"block.top\""})
        CHECK_THAT(text, Contains(name));
}

TEST_CASE("Coloured surfaces have every side with its area", "[export]") {
    const auto& e = *solution().enclosure;
    const auto files = exports::coloured_obj(solution(), "room");
    REQUIRE(files.beside.size() == 1);
    CHECK(files.beside[0].name == "room.mtl");
    const Written obj(".obj", files.main);
    double area = 0.0;
    for (const auto& side : e.sides) {
        area += side.area;
        CHECK_THAT(files.beside[0].bytes, Contains("newmtl " + side.name + "\n"));
    }
    // Faces that are there twice are dropped by the reader: both sides of the partition.
    double twice = 0.0, found = 0.0;
    for (const auto& side : e.sides)
        if (side.name == "left-" || side.name == "right-") twice += side.area;
    for (const auto& face : mesh::read_mesh_file(obj.path).faces) {
        const double of_face = area_of(face.polygons);
        found += of_face;
        const auto side = std::ranges::find(e.sides, face.name, &radiosity::SurfaceSide::name);
        REQUIRE(side != e.sides.end());
        if (!face.name.starts_with("left") && !face.name.starts_with("right"))
            CHECK(of_face == Approx(side->area).epsilon(1e-6));  // nine digits
    }
    CHECK(found >= (area - twice) * (1.0 - 1e-6));
    const Written ply(".ply", exports::coloured_ply(solution()).main);
    found = 0.0;
    for (const auto& face : mesh::read_mesh_file(ply.path).faces) found += area_of(face.polygons);
    CHECK(found >= (area - twice) * (1.0 - 1e-5));  // single precision
}

TEST_CASE("Colours are the tone-mapped radiance, numbers the radiosity", "[export]") {
    // In a furnace everything has radiance 1.
    auto scene = test::open_floor(0.7);
    scene.environment = {1.0};
    const auto furnace = radiosity::solve_adaptively(
        test::enclosed(scene), {.error = 0.5, .start = radiosity::Start::base, .rays = 16});
    const auto bytes = exports::coloured_ply(furnace, {.white = 2.0}).main;
    const auto begin = bytes.find("end_header\n") + 11;
    const auto patches = furnace.report.patches;
    REQUIRE(bytes.size() == begin + patches * (3 * (12 + 3 + 4) + 13));
    // The floor sees nothing but the sky, of which it gives back 0.7; of the shoulder (tone_map.h)
    // 0.7/2 of white is x = 0.77, beyond its linear part.
    const double light = 1.0 - 0.4 * std::pow(1.0 - (0.77 - 0.6) / 1.6, 4);
    const double code = 255.0 * (1.055 * std::pow(light, 1.0 / 2.4) - 0.055);
    for (std::size_t p = 0; p < 3 * patches; ++p) {
        const char* point = bytes.data() + begin + 19 * p;
        for (int k = 12; k < 15; ++k)  // rounded to whole codes
            CHECK(std::abs(static_cast<std::uint8_t>(point[k]) - code) < 0.51);
        float radiosity;
        std::memcpy(&radiosity, point + 15, 4);
        CHECK(radiosity == Approx(0.7 * std::numbers::pi).epsilon(1e-5));
    }
    CHECK_THROWS_WITH(exports::coloured_ply(furnace, {.white = 0.0}), Contains("above 0"));
}

TEST_CASE("A VTU file holds all columns", "[export]") {
    const auto text = exports::vtu_file(solution()).main;
    for (const char* name : {"radiosity", "source_radiance_gradient", "name_id", "connectivity",
                             "offsets", "types", "radiance"})
        CHECK_THAT(text, Contains("Name=\"" + std::string(name) + "\""));
    CHECK(text.ends_with("</VTKFile>\n"));
}
