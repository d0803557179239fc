#include "cli/scene_surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "cli/scene_keys.h"
#include "cli/scene_optics.h"
#include "mesh/input_error.h"
#include "mesh/mesh_file.h"
#include "mesh/shapes.h"

namespace tyndall::cli {
namespace {

using mesh::Face;

std::string opening_name(const TableReader& reader) {
    const std::string name = reader.text("name");
    const std::string trouble = name_trouble(name);
    if (!trouble.empty()) {
        reader.fail("name", fmt::format("the name \"{}\" of this opening {}. Give another name.",
                                        name, trouble));
    }
    return name;
}

mesh::Opening read_opening(const TableReader& reader) {
    const auto corner = reader.vector2("corner", coordinate),
               size = reader.vector2("size", positive);
    return {opening_name(reader), {corner.x, corner.y}, {size.x, size.y}};
}

// Runs `make`; what mesh/ has to say about the shape gets its place and name.
template <class Make>
std::vector<Face> made(const TableReader& reader, Make&& make) {
    try {
        return make();
    } catch (const mesh::InputError& error) {
        fail_at(reader.where(), fmt::format("{}: {}", reader.thing(), error.what()));
    }
}

std::vector<Face> read_cuboid(const TableReader& surface, std::string_view kind) {
    const TableReader reader = surface.table(kind, keys::cuboid());
    const auto min = reader.vector("min", coordinate), max = reader.vector("max", coordinate);
    std::vector<mesh::FaceOpening> openings;
    for (const toml::table* table : reader.tables("openings")) {
        const TableReader opening(*table, keys::face_opening(), "an opening of " + surface.thing());
        openings.push_back({opening.text("face"), read_opening(opening)});
    }
    return made(reader, [&] {
        return kind == "room" ? mesh::room(min, max, openings) : mesh::box(min, max, openings);
    });
}

std::vector<Face> read_rectangle(const TableReader& surface) {
    const TableReader reader = surface.table("rectangle", keys::rectangle());
    const auto corner = reader.vector("corner", coordinate);
    const auto u = reader.vector("u", coordinate), v = reader.vector("v", coordinate);
    std::vector<mesh::Opening> openings;
    for (const toml::table* table : reader.tables("openings")) {
        const TableReader opening(*table, keys::opening(), "an opening of " + surface.thing());
        openings.push_back(read_opening(opening));
    }
    return made(reader, [&] { return mesh::rectangle(corner, u, v, openings); });
}

std::vector<Face> read_polygons(const TableReader& surface) {
    Face face;
    const toml::array& list = surface.array("polygons");
    if (list.empty()) {
        surface.fail("polygons", fmt::format("polygons of {} is empty. Give at least one polygon.",
                                             surface.thing()));
    }
    for (std::size_t i = 0; i < list.size(); ++i) {
        const std::string what = fmt::format("polygon {} of {}", i + 1, surface.thing());
        const std::string place = place_of(list[i].source());
        const toml::array* corners = list[i].as_array();
        if (!corners) {
            fail_at(place,
                    fmt::format("{} is {}; an array of corners is expected. Give [[x, y, z], …].",
                                what, type_of(list[i])));
        }
        mesh::Polygon polygon;
        for (const toml::node& corner : *corners) {
            polygon.corners.push_back(surface.vector_at(corner, "corner of " + what, coordinate));
        }
        try {
            mesh::check_polygon(polygon);
        } catch (const mesh::InputError& error) {
            fail_at(place, fmt::format("{} {}", what, error.what()));
        }
        face.polygons.push_back(std::move(polygon));
    }
    return {face};
}

// Characters that names may not hold become '_': group names come from other programs.
std::string group_name(std::string name) {
    for (char& c : name) {
        const bool bad = c == '.' || c == '+' || c == '=' || c == ',' || c == '"' || c == ' ' ||
                         static_cast<unsigned char>(c) < 0x20;
        if (bad) c = '_';
    }
    if (!name.empty() && name.back() == '-') name.back() = '_';
    return name;
}

std::vector<Face> read_file(const TableReader& surface, const std::filesystem::path& folder,
                            std::vector<std::string>& notes) {
    const std::string name = surface.text("file");
    if (name.empty()) {
        surface.fail("file",
                     fmt::format("file of {} is empty. Give the path of an OBJ, PLY, STL or OFF "
                                 "file.",
                                 surface.thing()));
    }
    try {
        mesh::MeshFile file = mesh::read_mesh_file(folder / name);
        for (const std::string& note : file.notes) notes.push_back(name + ": " + note);
        for (Face& face : file.faces) face.name = group_name(face.name);
        return std::move(file.faces);
    } catch (const mesh::InputError& error) {
        surface.fail("file", fmt::format("file of {}: {}", surface.thing(), error.what()));
    }
}

std::vector<Face> read_shape(const TableReader& surface, const std::filesystem::path& folder,
                             std::vector<std::string>& notes) {
    constexpr std::array<std::string_view, 5> kinds{"room", "box", "rectangle", "polygons", "file"};
    const std::string_view kind = surface.exactly_one(kinds);
    if (kind == "rectangle") return read_rectangle(surface);
    if (kind == "polygons") return read_polygons(surface);
    if (kind == "file") return read_file(surface, folder, notes);
    return read_cuboid(surface, kind);
}

// x → rotation (scale x) + translation.
struct Placement {
    glm::dmat3 linear{1.0};
    glm::dvec3 translation{0.0};  // [m]
};

// Rodrigues' formula; quarter turns are exact, so that walls stay axis-aligned.
glm::dmat3 rotation(glm::dvec3 axis, double degrees) {
    const double turn = std::remainder(degrees, 360.0);
    double sine = std::sin(turn * M_PI / 180.0), cosine = std::cos(turn * M_PI / 180.0);
    if (std::remainder(turn, 90.0) == 0.0) {
        sine = std::round(sine);
        cosine = std::round(cosine);
    }
    const glm::dmat3 cross(0, axis.z, -axis.y, -axis.z, 0, axis.x, axis.y, -axis.x, 0);  // columns
    return cosine * glm::dmat3(1.0) + sine * cross + (1.0 - cosine) * glm::outerProduct(axis, axis);
}

Placement read_placement(const TableReader& surface) {
    Placement placement;
    glm::dvec3 scale(1.0);
    if (surface.has("scale")) {
        constexpr Range range{-1e9, 1e9};
        scale = surface.node("scale").is_array() ? surface.vector("scale", range)
                                                 : glm::dvec3(surface.number("scale", range));
        if (scale.x == 0.0 || scale.y == 0.0 || scale.z == 0.0) {
            surface.fail("scale",
                         fmt::format("scale of {} is 0, which leaves nothing. Give other than 0.",
                                     surface.thing()));
        }
    }
    if (surface.has("rotate")) {
        const TableReader rotate = surface.table("rotate", keys::rotate());
        placement.linear =
            rotation(read_direction(rotate, "axis"), rotate.number("degrees", {-1e6, 1e6}));
    }
    for (int axis = 0; axis < 3; ++axis) placement.linear[axis] *= scale[axis];
    if (surface.has("translate")) placement.translation = surface.vector("translate", coordinate);
    return placement;
}

void place(const Placement& placement, mesh::Polygon& polygon) {
    for (mesh::Point& corner : polygon.corners) {
        corner = placement.linear * corner + placement.translation;
    }
    // A mirror image keeps the fronts where the shape had them.
    if (glm::determinant(placement.linear) < 0.0) {
        std::reverse(polygon.corners.begin(), polygon.corners.end());
    }
}

}  // namespace

void read_surfaces(const TableReader& root, const std::filesystem::path& folder,
                   const Names& materials, radiosity::Scene& scene,
                   std::vector<std::string>& notes) {
    Names names("surface"), parts("surface");
    for (const toml::table* table : root.tables("surface")) {
        const std::string name = names.take(*table);
        const TableReader reader(*table, keys::surface(), fmt::format("surface \"{}\"", name));
        std::optional<std::size_t> material;
        if (reader.has("material")) material = materials.find(reader, "material");
        const Placement placement = read_placement(reader);

        for (Face& face : read_shape(reader, folder, notes)) {
            radiosity::Surface surface;
            surface.name = face.name.empty() ? name : name + "." + face.name;
            surface.where = reader.where();
            parts.take(surface.name, surface.where);
            for (mesh::Polygon& polygon : face.polygons) {
                place(placement, polygon);
                polygon.name = surface.name;
                // Openings are interfaces already; without material all of a surface is one.
                if (!material) polygon.opacity = mesh::Opacity::interface;
            }
            const bool passes = face.polygons.front().opacity == mesh::Opacity::interface;
            if (!passes) surface.material = material;
            surface.polygons = std::move(face.polygons);
            scene.surfaces.push_back(std::move(surface));
        }
    }
    if (scene.surfaces.empty()) {
        fail_at(root.where(), "the scene has no surface. Add one: [[surface]].");
    }
}

}  // namespace tyndall::cli
