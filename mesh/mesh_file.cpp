#include "mesh/mesh_file.h"

#include <fmt/format.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/IO/importer/BaseImporter.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>

#include "mesh/face_soup.h"
#include "mesh/input_error.h"

namespace tyndall::mesh {
namespace {

// OpenMesh rounds to float: the shortest decimal that rounds to the same float is what the file
// most likely said (0.1, not 0.10000000149).
double unrounded(float value) {
    if (!std::isfinite(value)) return value;
    return std::stod(fmt::format("{}", value));
}

// Takes what a reader finds as it is. A mesh of OpenMesh would double vertices of edges that more
// than two faces share, without a word, and print about it.
class SoupImporter final : public OpenMesh::IO::BaseImporter {
  public:
    FaceSoup soup;
    bool finite = true;
    std::size_t bad_index = 0;  // first index out of range
    bool in_range = true;

    using Vertex = OpenMesh::VertexHandle;
    using Halfedge = OpenMesh::HalfedgeHandle;
    using Edge = OpenMesh::EdgeHandle;
    using FaceH = OpenMesh::FaceHandle;
    template <class T, int size>
    using Vec = OpenMesh::VectorT<T, size>;
    using Status = OpenMesh::Attributes::StatusInfo;

    Vertex add_vertex(const OpenMesh::Vec3f& p) override {
        return add({unrounded(p[0]), unrounded(p[1]), unrounded(p[2])});
    }
    Vertex add_vertex(const OpenMesh::Vec3d& p) override { return add({p[0], p[1], p[2]}); }
    Vertex add_vertex() override { return add(Point(0.0)); }
    void set_point(Vertex v, const OpenMesh::Vec3f& p) override {
        const Point point{unrounded(p[0]), unrounded(p[1]), unrounded(p[2])};
        check(point);
        soup.points.at(static_cast<std::size_t>(v.idx())) = point;
    }
    FaceH add_face(const VHandles& corners) override {
        SoupFace face;
        for (const Vertex v : corners) {
            const auto index = static_cast<std::size_t>(v.idx());
            if (index >= soup.points.size()) {
                if (in_range) bad_index = index;
                in_range = false;
                return FaceH(-1);
            }
            face.corners.push_back(static_cast<std::uint32_t>(index));
        }
        soup.faces.push_back(std::move(face));
        return FaceH(static_cast<int>(soup.faces.size()) - 1);
    }
    size_t n_vertices() const override { return soup.points.size(); }
    size_t n_faces() const override { return soup.faces.size(); }
    size_t n_edges() const override { return 0; }

    // What surfaces have no use for.
    Halfedge add_edge(Vertex, Vertex) override { return Halfedge(-1); }
    FaceH add_face(Halfedge) override { return FaceH(-1); }
    void add_face_texcoords(FaceH, Vertex, const std::vector<OpenMesh::Vec2f>&) override {}
    void add_face_texcoords(FaceH, Vertex, const std::vector<OpenMesh::Vec3f>&) override {}
    void set_face_texindex(FaceH, int) override {}
    void set_halfedge(Vertex, Halfedge) override {}
    void set_normal(Vertex, const OpenMesh::Vec3f&) override {}
    void set_normal(Vertex, const OpenMesh::Vec3d&) override {}
    void set_color(Vertex, const OpenMesh::Vec3uc&) override {}
    void set_color(Vertex, const OpenMesh::Vec4uc&) override {}
    void set_color(Vertex, const OpenMesh::Vec3f&) override {}
    void set_color(Vertex, const OpenMesh::Vec4f&) override {}
    void set_texcoord(Vertex, const OpenMesh::Vec2f&) override {}
    void set_status(Vertex, const Status&) override {}
    void set_next(Halfedge, Halfedge) override {}
    void set_face(Halfedge, FaceH) override {}
    void request_face_texcoords2D() override {}
    void set_texcoord(Halfedge, const OpenMesh::Vec2f&) override {}
    void set_texcoord(Vertex, const OpenMesh::Vec3f&) override {}
    void set_texcoord(Halfedge, const OpenMesh::Vec3f&) override {}
    void set_status(Halfedge, const Status&) override {}
    void set_color(Edge, const OpenMesh::Vec3uc&) override {}
    void set_color(Edge, const OpenMesh::Vec4uc&) override {}
    void set_color(Edge, const OpenMesh::Vec3f&) override {}
    void set_color(Edge, const OpenMesh::Vec4f&) override {}
    void set_status(Edge, const Status&) override {}
    void set_normal(FaceH, const OpenMesh::Vec3f&) override {}
    void set_normal(FaceH, const OpenMesh::Vec3d&) override {}
    void set_color(FaceH, const OpenMesh::Vec3uc&) override {}
    void set_color(FaceH, const OpenMesh::Vec4uc&) override {}
    void set_color(FaceH, const OpenMesh::Vec3f&) override {}
    void set_color(FaceH, const OpenMesh::Vec4f&) override {}
    void set_status(FaceH, const Status&) override {}
    void add_texture_information(int, std::string) override {}

  private:
    void check(const Point& p) {
        finite = finite && std::abs(p.x) <= 1e9 && std::abs(p.y) <= 1e9 && std::abs(p.z) <= 1e9;
    }
    Vertex add(const Point& p) {
        check(p);
        soup.points.push_back(p);
        return Vertex(static_cast<int>(soup.points.size()) - 1);
    }
};

// Keeps OpenMesh's messages from the terminal while it lives; `text` has them.
class Quiet {
  public:
    Quiet() {
        omerr().disconnect(std::cerr);
        omlog().disconnect(std::clog);
        omerr().connect(text_);
    }
    ~Quiet() {
        omerr().disconnect(text_);
        omerr().connect(std::cerr);
        omlog().connect(std::clog);
    }
    Quiet(const Quiet&) = delete;
    Quiet& operator=(const Quiet&) = delete;

  private:
    std::ostringstream text_;
};

std::string read_text(const std::filesystem::path& path) {
    const std::string name = path.string();
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (status.type() == std::filesystem::file_type::not_found) {
        throw InputError(fmt::format("{}: there is no such file. Correct the path.", name));
    }
    if (std::filesystem::is_directory(status)) {
        throw InputError(fmt::format("{}: this is a directory. Give a file in it.", name));
    }
    std::ifstream stream(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    if (!stream.is_open() || stream.bad()) {
        throw InputError(fmt::format("{}: cannot be read. Check its permissions.", name));
    }
    if (text.find_first_not_of(" \t\r\n") == text.npos) {
        throw InputError(fmt::format("{}: the file is empty. Export it again.", name));
    }
    return text;
}

FaceSoup read_by_openmesh(const std::string& text, const std::string& name,
                          const std::string& extension) {
    const FileCounts counts = check_mesh_text(text, name, extension);
    SoupImporter importer;
    OpenMesh::IO::Options options;
    bool read = false;
    {
        const Quiet quiet;
        if (extension == "ply") {  // the only reader that finds out by itself what is binary
            read = OpenMesh::IO::IOManager().read(name, importer, options);
        } else {
            if (counts.binary) options += OpenMesh::IO::Options::Binary;
            std::istringstream stream(text);
            read = OpenMesh::IO::IOManager().read(stream, extension, importer, options);
        }
    }
    if (!importer.in_range) {
        throw InputError(
            fmt::format("{}: a face has vertex {} (counted from 0), there are {}. Is the "
                        "file truncated?",
                        name, importer.bad_index, importer.soup.points.size()));
    }
    if (!importer.finite) {
        throw InputError(
            fmt::format("{}: a coordinate is not finite or beyond 1e9 m. Correct it.", name));
    }
    const std::size_t vertices = importer.soup.points.size(), faces = importer.soup.faces.size();
    const bool short_of =
        (counts.vertices && vertices < *counts.vertices) || (counts.faces && faces < *counts.faces);
    if (!read || short_of) {
        throw InputError(
            fmt::format("{}: cannot be read whole: {} vertices and {} faces were found. Is it "
                        "truncated, or of another format than its name says?",
                        name, vertices, faces));
    }
    return std::move(importer.soup);
}

}  // namespace

MeshFile read_mesh_file(const std::filesystem::path& path) {
    const std::string name = path.string();
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (!extension.empty()) extension.erase(0, 1);
    if (extension != "obj" && extension != "ply" && extension != "stl" && extension != "off") {
        throw InputError(
            fmt::format("{}: \"{}\" is the extension of no known format. Give an OBJ, PLY, STL "
                        "or OFF file.",
                        name, extension));
    }
    const std::string text = read_text(path);
    FaceSoup soup =
        extension == "obj" ? read_obj(text, name) : read_by_openmesh(text, name, extension);
    if (soup.faces.empty()) {
        throw InputError(fmt::format("{}: there is no face in it. Export it again.", name));
    }
    MeshFile file = mend(std::move(soup));
    if (file.faces.empty()) {
        throw InputError(fmt::format("{}: no face has an area. Export it again.", name));
    }
    return file;
}

}  // namespace tyndall::mesh
