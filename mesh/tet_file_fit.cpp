#include "mesh/tet_file_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "mesh/base_mesh_build.h"
#include "mesh/input_error.h"
#include "mesh/tet_file_fill.h"
#include "mesh/tet_file_surfaces.h"

namespace tyndall::mesh {
namespace {

tetgen::Hull box_of(std::span<const Point> points, tetgen::Hull box) {
    for (const Point& p : points) {
        box.min = glm::min(box.min, p);
        box.max = glm::max(box.max, p);
    }
    return box;
}

double diagonal(const tetgen::Hull& box) {
    return glm::distance(box.min, box.max);
}

double six_volumes(std::span<const Point> points, const std::array<std::uint32_t, 4>& c) {
    const Point& a = points[c[0]];
    return glm::dot(glm::cross(points[c[1]] - a, points[c[2]] - a), points[c[3]] - a);
}

// Tets whose corners stand for others get these; one that moving its nodes made flat is refused.
TetFile moved(TetFile file, const FittedNodes& nodes) {
    for (std::size_t t = 0; t < file.tets.size(); ++t) {
        auto& corners = file.tets[t].corners;
        for (auto& corner : corners) corner = nodes.same[corner];
        double longest = 0.0;
        for (int j = 0; j < 4; ++j)
            for (int k = 0; k < j; ++k)
                longest = std::max(
                    longest, glm::distance(nodes.points[corners[j]], nodes.points[corners[k]]));
        const Point x = nodes.points[corners[0]];
        if (!(six_volumes(nodes.points, corners) > flat_tet * longest * longest * longest))
            throw InputError(fmt::format(
                "{} near [{:.6g}, {:.6g}, {:.6g}] is flat once its corners are moved onto the "
                "scene's surfaces, which they come nearer than {:g} of the scene's size. Mesh "
                "this place coarser.",
                file.place(t), x.x, x.y, x.z, fit_tolerance));
    }
    return file;
}

// Whether the tets fill a box, with all of the scene inside.
bool fills_box(const TetFile& file, const FittedNodes& nodes, const ConformingComplex& complex,
               const tetgen::Hull& box) {
    double volume = 0.0;
    for (const FileTet& tet : file.tets) volume += six_volumes(nodes.points, tet.corners) / 6.0;
    const auto extent = box.max - box.min;
    const double wanted = extent.x * extent.y * extent.z;
    if (std::abs(volume - wanted) > 1e-9 * wanted) return false;
    const double margin = fit_tolerance * diagonal(box);
    return std::all_of(complex.points.begin(), complex.points.end(), [&](const Point& p) {
        return glm::all(glm::greaterThan(p, box.min + margin)) &&
               glm::all(glm::lessThan(p, box.max - margin));
    });
}

struct Parts {
    tetgen::Output all;
    std::vector<FilledTet> filled;
};

void add(tetgen::Output& output, const FacetGroups& groups, const SurfaceFace& face) {
    output.faces.push_back(face.corners);
    output.face_markers.push_back(static_cast<std::int32_t>(groups.group(face.source) + 1));
}

void add(Parts& parts, const FacetGroups& groups, const Filling& filling) {
    auto& all = parts.all;
    all.points.insert(all.points.end(), filling.points.begin(), filling.points.end());
    for (const auto& tet : filling.tets) {
        all.tets.push_back(tet);
        Point centroid(0);
        for (const auto corner : tet) centroid += 0.25 * all.points[corner];
        parts.filled.push_back({centroid, std::abs(six_volumes(all.points, tet)) / 6.0});
    }
    for (const auto& face : filling.faces) add(all, groups, face);
}

std::string file_notes(const TetFile& file) {
    std::string text;
    for (const auto& note : file.notes) text += (text.empty() ? "" : "; ") + note;
    return text;
}

}  // namespace

FittedMesh fit_tetrahedra(const TetFile& given, const ConformingComplex& complex,
                          std::span<const Polygon> polygons, const TetrahedralizeOptions& options) {
    if (complex.facets.empty())
        throw InputError("There are no surfaces to mesh. Add at least one.");
    const tetgen::Hull scene = box_of(complex.points, {complex.points[0], complex.points[0]});
    const double tolerance = fit_tolerance * diagonal(scene);
    const FacetFinder finder(complex, tolerance);
    const FittedNodes nodes = fit_nodes(given, complex, finder, tolerance);
    const TetFile file = moved(given, nodes);
    const auto faces = faces_of(file, nodes.points);
    const FacetGroups groups = sheets_of(complex, polygons);
    const auto matched = match_surfaces(file, complex, polygons, groups, finder, nodes, faces);

    Parts parts;
    parts.all.points = nodes.points;
    for (const FileTet& tet : file.tets) parts.all.tets.push_back(tet.corners);
    for (const auto& face : matched.faces) add(parts.all, groups, face);
    const Point start = nodes.points[file.tets[0].corners[0]];
    tetgen::Hull hull = box_of(nodes.points, {start, start});
    if (!fills_box(file, nodes, complex, hull)) {
        hull = box_of(nodes.points, scene);
        const Point grow(options.hull_margin * diagonal(hull));
        hull = {hull.min - grow, hull.max + grow};
        add(parts, groups, fill_hull(file, complex, nodes, faces, matched.outside, hull, options));
    }
    FittedMesh result;
    try {
        result.mesh = tetgen::build_base_mesh(parts.all, complex, groups, hull);
    } catch (const tetgen::Fault& fault) {
        throw InputError(
            fmt::format("{}: the tetrahedra cannot be the scene's mesh: {}. Mesh the "
                        "volume again, with the surfaces as constraints.",
                        file.name, fault.what()));
    }
    result.filled = std::move(parts.filled);
    if (const auto text = file_notes(file); !text.empty())
        result.notes.push_back(file.name + ": " + text);
    return result;
}

}  // namespace tyndall::mesh
