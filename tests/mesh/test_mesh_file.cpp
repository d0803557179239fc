#include "mesh/mesh_file.h"

#include <array>
#include <cstring>
#include <fstream>
#include <glm/geometric.hpp>

#include "mesh/input_error.h"
#include "support/catch.h"
#include "support/own_folder.h"

using namespace tyndall::mesh;
namespace fs = std::filesystem;

namespace {

struct TemporaryFile {
    fs::path path;
    TemporaryFile(const std::string& name, const std::string& content)
        : path(tyndall::test::own_folder() / name) {
        std::ofstream(path, std::ios::binary) << content;
    }
    ~TemporaryFile() { fs::remove(path); }
};

MeshFile read(const std::string& name, const std::string& content) {
    return read_mesh_file(TemporaryFile(name, content).path);
}

std::string message_of(const std::string& name, const std::string& content) {
    try {
        read(name, content);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

// By the divergence theorem [m^3].
double volume(const MeshFile& file) {
    double sum = 0.0;
    for (const Face& face : file.faces) {
        for (const Polygon& p : face.polygons) {
            for (std::size_t i = 1; i + 1 < p.corners.size(); ++i) {
                sum += glm::dot(p.corners[0], glm::cross(p.corners[i], p.corners[i + 1])) / 6.0;
            }
        }
    }
    return sum;
}

std::size_t polygons(const MeshFile& file) {
    std::size_t count = 0;
    for (const Face& face : file.faces) count += face.polygons.size();
    return count;
}

// A tetrahedron on three edges of 0.1 m, fronts outward: numbers that float cannot hold.
constexpr std::array<std::array<int, 3>, 4> sides{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
const char* points[4] = {"0 0 0", "0.1 0 0", "0 0.1 0", "0 0 0.1"};
constexpr double tet_volume = 0.001 / 6;

std::string obj() {
    std::string text = "# a tetrahedron\nmtllib none.mtl\n";
    for (const char* p : points) text += std::string("v ") + p + "\n";
    text += "vn 0 0 1\nvt 0 0\n";
    for (const auto& s : sides) {
        text += "f";
        for (const int i : s) text.append(" ").append(std::to_string(i + 1)).append("/1/1");
        text += "\n";
    }
    return text;
}

std::string off() {
    std::string text = "OFF\n4 4 6\n";
    for (const char* p : points) text += std::string(p) + "\n";
    for (const auto& s : sides) {
        text += "3 " + std::to_string(s[0]) + " " + std::to_string(s[1]) + " " +
                std::to_string(s[2]) + "\n";
    }
    return text;
}

std::string ply(const std::string& format) {
    return "ply\nformat " + format +
           " 1.0\ncomment a tetrahedron\nelement vertex 4\nproperty float x\nproperty float y\n"
           "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
}

std::string ascii_ply() {
    const std::string body = off();
    return ply("ascii") + body.substr(body.find('\n', 4) + 1);
}

template <class T>
void append(std::string& bytes, T value) {
    char buffer[sizeof(T)];
    std::memcpy(buffer, &value, sizeof(T));
    bytes.append(buffer, sizeof(T));
}

void append_point(std::string& bytes, int i) {
    for (int axis = 0; axis < 3; ++axis) append(bytes, i == axis + 1 ? 0.1f : 0.0f);
}

std::string binary_ply() {
    std::string bytes = ply("binary_little_endian");
    for (int i = 0; i < 4; ++i) append_point(bytes, i);
    for (const auto& s : sides) {
        append(bytes, static_cast<unsigned char>(3));
        for (const int i : s) append(bytes, std::int32_t(i));
    }
    return bytes;
}

std::string ascii_stl() {
    std::string text = "solid part\n";
    for (const auto& s : sides) {
        text += " facet normal 0 0 0\n  outer loop\n";
        for (const int i : s) text += std::string("   vertex ") + points[i] + "\n";
        text += "  endloop\n endfacet\n";
    }
    return text + "endsolid part\n";
}

// `head` may well be "solid", in spite of the format.
std::string binary_stl(std::string head = "part") {
    head.resize(80, ' ');
    append(head, std::uint32_t(4));
    for (const auto& s : sides) {
        head.append(12, '\0');
        for (const int i : s) append_point(head, i);
        append(head, std::uint16_t(0));
    }
    return head;
}

}  // namespace

TEST_CASE("Every format gives the same tetrahedron, with the numbers of the text") {
    const std::vector<std::pair<std::string, std::string>> files{
        {"tet.obj", obj()},
        {"tet.off", off()},
        {"tet.ply", ascii_ply()},
        {"tet_binary.ply", binary_ply()},
        {"tet.stl", ascii_stl()},
        {"tet_binary.stl", binary_stl()},
        {"tet_solid.stl", binary_stl("solid by a careless program")},
        {"TET.OFF", off()}};
    for (const auto& [name, content] : files) {
        INFO(name);
        const MeshFile file = read(name, content);
        REQUIRE(file.faces.size() == 1);
        CHECK(file.faces[0].name == "");
        CHECK(polygons(file) == 4);
        CHECK(volume(file) == Approx(tet_volume).epsilon(1e-12));
        for (const Polygon& p : file.faces[0].polygons) {
            for (const Point& c : p.corners) {
                for (int axis = 0; axis < 3; ++axis) CHECK((c[axis] == 0.0 || c[axis] == 0.1));
            }
        }
        CHECK(file.notes.empty());
    }
}

TEST_CASE("OBJ groups become faces; objects do where no group is named") {
    const std::string v = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\n";
    const MeshFile groups =
        read("groups.obj",
             v + "o thing\nf 1 2 3\ng shaft\nf -5 -4 -1\ng base\nf 1 3 4\ng shaft\nf 2 3 5\n");
    REQUIRE(groups.faces.size() == 3);
    CHECK(groups.faces[0].name == "");
    CHECK(groups.faces[1].name == "shaft");
    CHECK(groups.faces[1].polygons.size() == 2);
    CHECK(groups.faces[2].name == "base");
    const MeshFile objects = read("objects.obj", v + "o one\ng\nf 1 2 3\no two\nf 1 2 5\n");
    REQUIRE(objects.faces.size() == 2);
    CHECK(objects.faces[1].name == "two");
}

TEST_CASE("Vertices are welded, faces without area and second copies dropped, and said so") {
    const std::string text =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
        "v 0 0 1e-9\nv 1 1 0\nv 0.5 0 0\n"
        "f 1 2 3\nf 5 6 4\nf 2 3 1\nf 1 7 2\nf 1 5 3\n";
    const MeshFile file = read("mend.obj", text);
    CHECK(polygons(file) == 2);
    REQUIRE(file.notes.size() == 3);
    CHECK(file.notes[0] == "welded 2 of 7 vertices");
    CHECK(file.notes[1] == "dropped 2 faces without area");
    CHECK(file.notes[2] == "dropped 1 face that were there twice");
    CHECK(file.faces[0].polygons[0].corners[0] == file.faces[0].polygons[1].corners[0]);
}

TEST_CASE("Polygons stay whole if they are planar, convex or not, and are cut if not") {
    const std::string l_shape = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n";
    CHECK(polygons(read("l.obj", l_shape + "f 1 2 3 4 5 6\n")) == 1);
    const std::string bent = "v 0 0 0.1\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n";
    const MeshFile cut = read("bent.obj", bent + "f 1 2 3 4 5 6\n");
    CHECK(polygons(cut) == 4);
    double area = 0.0;  // seen along z the pieces cover the L once
    for (const Polygon& p : cut.faces[0].polygons) {
        const double z =
            0.5 * glm::cross(p.corners[1] - p.corners[0], p.corners[2] - p.corners[0]).z;
        CHECK(z > 0.0);
        area += z;
    }
    CHECK(area == Approx(3.0));
    CHECK(cut.notes.at(0) == "cut 1 face that were not planar into triangles");
}

TEST_CASE("Edges that three faces share keep their vertices") {
    const MeshFile file = read("fan.off",
                               "OFF\n5 3 0\n0 0 0\n0 0 1\n1 0 0\n0 1 0\n-1 0 0\n"
                               "3 0 1 2\n3 0 1 3\n3 0 1 4\n");
    CHECK(polygons(file) == 3);
    CHECK(file.notes.empty());
}

TEST_CASE("No cut of a mesh file crashes a reader; most are refused") {
    const std::vector<std::pair<std::string, std::string>> files{
        {"cut.obj", obj()},       {"cut.off", off()},
        {"cut.ply", ascii_ply()}, {"cut_binary.ply", binary_ply()},
        {"cut.stl", ascii_stl()}, {"cut_binary.stl", binary_stl()}};
    for (const auto& [name, content] : files) {
        for (std::size_t size = 0; size + 8 < content.size(); size += 3) {
            INFO(name << " cut to " << size << " bytes");
            const std::string message = message_of(name, content.substr(0, size));
            if (name != "cut.obj") CHECK(message != "");  // OBJ has no end
            if (message != "") CHECK(message.find(name) != std::string::npos);
        }
    }
}

TEST_CASE("No changed byte of a mesh file crashes a reader") {
    const std::vector<std::pair<std::string, std::string>> files{
        {"changed.obj", obj()},       {"changed.off", off()},
        {"changed.ply", ascii_ply()}, {"changed_binary.ply", binary_ply()},
        {"changed.stl", ascii_stl()}, {"changed_binary.stl", binary_stl()}};
    for (const auto& [name, content] : files) {
        for (std::size_t i = 0; i < content.size(); ++i) {
            for (const char c : {'9', '-', '\0', '\xff', ' '}) {
                std::string changed = content;
                changed[i] = c;
                CHECK_NOTHROW(message_of(name, changed));
            }
        }
    }
}
