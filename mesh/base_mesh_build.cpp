#include "mesh/base_mesh_build.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>

#include "mesh/hilbert.h"

namespace tyndall::mesh::tetgen {

namespace {

using FaceKey = std::array<std::uint32_t, 3>;

// The face opposite corner k, counter-clockwise seen from inside a positive tet.
constexpr std::array<std::array<int, 3>, 4> inward{{{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}}};

double six_volumes(const Point& a, const Point& b, const Point& c, const Point& d) {
    return glm::dot(glm::cross(b - a, c - a), d - a);
}

glm::dvec3 area_vector(const Point& a, const Point& b, const Point& c) {
    return 0.5 * glm::cross(b - a, c - a);
}

void check_indices(const Output& output) {
    const auto inside = [&](auto i) { return i < output.points.size(); };
    for (const auto& tet : output.tets) {
        if (!std::all_of(tet.begin(), tet.end(), inside)) {
            throw Fault("a tetrahedron has a corner that does not exist");
        }
    }
    for (const auto& face : output.faces) {
        if (!std::all_of(face.begin(), face.end(), inside)) {
            throw Fault("a face has a corner that does not exist");
        }
    }
}

std::vector<std::size_t> hilbert_order(const Output& output, const Hull& hull) {
    constexpr int bits = 20;
    constexpr double cells = 1u << bits;
    std::vector<std::uint64_t> keys;
    keys.reserve(output.tets.size());
    const auto extent = hull.max - hull.min;
    for (const auto& tet : output.tets) {
        Point centroid(0.0);
        for (const auto i : tet) {
            centroid += 0.25 * output.points[i];
        }
        const auto cell = glm::clamp((centroid - hull.min) / extent * cells, 0.0, cells - 1.0);
        keys.push_back(
            hilbert_index({static_cast<std::uint32_t>(cell.x), static_cast<std::uint32_t>(cell.y),
                           static_cast<std::uint32_t>(cell.z)},
                          bits));
    }
    std::vector<std::size_t> order(output.tets.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return keys[a] < keys[b]; });
    return order;
}

// Fills points and tets; returns the new number of each of TetGen's points.
std::vector<VertexId> renumber(const Output& output, const Hull& hull, BaseMesh& mesh) {
    std::vector<VertexId> numbers(output.points.size());
    for (const auto t : hilbert_order(output, hull)) {
        std::array<VertexId, 4> corners;
        for (int k = 0; k < 4; ++k) {
            auto& number = numbers[output.tets[t][k]];
            if (!number.valid()) {
                number = VertexId(mesh.points.size());
                mesh.points.push_back(output.points[output.tets[t][k]]);
            }
            corners[k] = number;
        }
        mesh.tets.push_back(corners);
    }
    return numbers;
}

void orient(BaseMesh& mesh, const Hull& hull) {
    double total = 0.0, size = 0.0;
    for (auto& tet : mesh.tets) {
        const auto p = [&](int k) { return mesh.points[tet[k].value]; };
        double six = six_volumes(p(0), p(1), p(2), p(3));
        if (six < 0.0) {
            std::swap(tet[2], tet[3]);
            six = -six;
        }
        if (!(six > 0.0)) {
            throw Fault(fmt::format("a tetrahedron near ({:.6g}, {:.6g}, {:.6g}) is flat", p(0).x,
                                    p(0).y, p(0).z));
        }
        total += six / 6.0;
    }
    const auto extent = hull.max - hull.min;
    size = extent.x * extent.y * extent.z;
    if (std::abs(total - size) > 1e-9 * size) {  // sums of 1e6 terms keep ten digits
        throw Fault(fmt::format("the tetrahedra fill {:.9g} m^3 of {:.9g} m^3", total, size));
    }
}

// A face of a tet under its sorted corners.
struct Face {
    FaceKey key;
    std::uint32_t tet;
    int k;

    bool operator<(const Face& other) const {
        return std::tie(key, tet) < std::tie(other.key, other.tet);
    }
};

FaceKey sorted(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    FaceKey key{a, b, c};
    std::sort(key.begin(), key.end());
    return key;
}

std::vector<Face> sorted_faces(const BaseMesh& mesh) {
    std::vector<Face> faces;
    faces.reserve(4 * mesh.tets.size());
    for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
        for (int k = 0; k < 4; ++k) {
            const auto& tet = mesh.tets[t];
            faces.push_back(
                {sorted(tet[inward[k][0]].value, tet[inward[k][1]].value, tet[inward[k][2]].value),
                 t, k});
        }
    }
    std::sort(faces.begin(), faces.end());
    return faces;
}

void link_neighbours(const std::vector<Face>& faces, const Hull& hull, BaseMesh& mesh) {
    mesh.neighbours.assign(mesh.tets.size(), {});
    double open = 0.0;
    for (std::size_t i = 0; i < faces.size();) {
        std::size_t end = i + 1;
        while (end < faces.size() && faces[end].key == faces[i].key) {
            ++end;
        }
        if (end - i > 2) {
            throw Fault("a face belongs to more than two tetrahedra");
        }
        if (end - i == 2) {
            mesh.neighbours[faces[i].tet][faces[i].k] = TetId(faces[i + 1].tet);
            mesh.neighbours[faces[i + 1].tet][faces[i + 1].k] = TetId(faces[i].tet);
        } else {
            const auto& key = faces[i].key;
            open += glm::length(
                area_vector(mesh.points[key[0]], mesh.points[key[1]], mesh.points[key[2]]));
        }
        i = end;
    }
    const auto e = hull.max - hull.min;
    const double box = 2.0 * (e.x * e.y + e.y * e.z + e.z * e.x);
    if (std::abs(open - box) > 1e-9 * box) {
        throw Fault(
            fmt::format("the mesh's outside is {:.9g} m^2 instead of {:.9g} m^2", open, box));
    }
}

// Whether `corners` run counter-clockwise seen from inside the tet of the face.
bool looks_into(const BaseMesh& mesh, const Face& face, const std::array<VertexId, 3>& corners) {
    const auto& tet = mesh.tets[face.tet];
    const auto& order = inward[face.k];
    for (int k = 0; k < 3; ++k) {
        if (tet[order[k]] == corners[0]) {
            return tet[order[(k + 1) % 3]] == corners[1];
        }
    }
    return false;
}

class FacetBuilder {
  public:
    FacetBuilder(const ConformingComplex& complex, const FacetGroups& groups,
                 const std::vector<Face>& faces, BaseMesh& mesh)
        : complex_(complex),
          groups_(groups),
          faces_(faces),
          mesh_(mesh),
          areas_(groups.size(), 0.0) {
        mesh_.tet_facets.assign(mesh_.tets.size(), {});
    }

    void add(std::array<VertexId, 3> corners, std::size_t group) {
        const auto centroid = (mesh_.points[corners[0].value] + mesh_.points[corners[1].value] +
                               mesh_.points[corners[2].value]) /
                              3.0;
        const auto source = groups_.member_at(group, centroid);
        const auto along = area_of(mesh_.points, corners);
        if (glm::dot(along, source_area(source)) < 0.0) {
            std::swap(corners[1], corners[2]);
        }
        areas_[group] += glm::length(along);
        const Face wanted{sorted(corners[0].value, corners[1].value, corners[2].value), 0, 0};
        const auto found = std::lower_bound(faces_.begin(), faces_.end(), wanted);
        if (found == faces_.end() || found->key != wanted.key || std::next(found) == faces_.end() ||
            std::next(found)->key != wanted.key) {
            throw Fault("a facet is not a face between two tetrahedra", source);
        }
        const auto other = std::next(found);
        const bool first_in_front = looks_into(mesh_, *found, corners);
        const auto& front = first_in_front ? *found : *other;
        const auto& back = first_in_front ? *other : *found;
        const FacetId id(mesh_.facets.size());
        for (const auto* side : {&front, &back}) {
            auto& slot = mesh_.tet_facets[side->tet][side->k];
            if (slot.valid()) {
                throw Fault("two facets lie on one face", source);
            }
            slot = id;
        }
        mesh_.facets.push_back({corners,
                                source,
                                complex_.facets[source.value].opacity,
                                {TetId(front.tet), TetId(back.tet)}});
    }

    void check_areas(double diagonal) const {
        for (std::size_t g = 0; g < areas_.size(); ++g) {
            const double wanted = groups_.area(g);
            // Slivers: coordinates are good to 1e-16 diagonals, areas to that times a diagonal.
            const double allowed = 1e-9 * wanted + 1e-13 * diagonal * diagonal;
            if (std::abs(areas_[g] - wanted) > allowed) {
                throw Fault(fmt::format("a surface came out with {:.9g} m^2 instead of {:.9g} m^2",
                                        areas_[g], wanted),
                            groups_.members(g).front());
            }
        }
    }

  private:
    static glm::dvec3 area_of(const std::vector<Point>& points,
                              const std::array<VertexId, 3>& corners) {
        return area_vector(points[corners[0].value], points[corners[1].value],
                           points[corners[2].value]);
    }
    glm::dvec3 source_area(FacetId source) const {
        return area_of(complex_.points, complex_.facets[source.value].corners);
    }

    const ConformingComplex& complex_;
    const FacetGroups& groups_;
    const std::vector<Face>& faces_;
    BaseMesh& mesh_;
    std::vector<double> areas_;  // of the output triangles, by group [m^2]
};

void add_facets(const Output& output, const ConformingComplex& complex, const FacetGroups& groups,
                const std::vector<VertexId>& numbers, const std::vector<Face>& faces,
                BaseMesh& mesh) {
    // In the order of their groups, then corners: not in TetGen's.
    std::vector<std::pair<std::uint32_t, std::array<VertexId, 3>>> found;
    for (std::size_t i = 0; i < output.faces.size(); ++i) {
        const auto marker = output.face_markers[i];
        if (marker >= 1 && static_cast<std::size_t>(marker) <= groups.size()) {
            std::array<VertexId, 3> corners;
            for (int k = 0; k < 3; ++k) {
                corners[k] = numbers[output.faces[i][k]];
                if (!corners[k].valid()) {
                    throw Fault("a face has a corner that no tetrahedron has");
                }
            }
            std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()),
                        corners.end());
            found.emplace_back(marker - 1, corners);
        }
    }
    std::sort(found.begin(), found.end());
    FacetBuilder builder(complex, groups, faces, mesh);
    for (const auto& [group, corners] : found) {
        builder.add(corners, group);
    }
    builder.check_areas(glm::distance(mesh.hull_min, mesh.hull_max));
}

}  // namespace

BaseMesh build_base_mesh(const Output& output, const ConformingComplex& complex,
                         const FacetGroups& groups, const Hull& hull) {
    if (output.tets.empty()) {
        throw Fault("there are no tetrahedra");
    }
    check_indices(output);
    BaseMesh mesh;
    mesh.hull_min = hull.min;
    mesh.hull_max = hull.max;
    const auto numbers = renumber(output, hull, mesh);
    orient(mesh, hull);
    const auto faces = sorted_faces(mesh);
    link_neighbours(faces, hull, mesh);
    add_facets(output, complex, groups, numbers, faces, mesh);
    find_regions(mesh);
    return mesh;
}

}  // namespace tyndall::mesh::tetgen
