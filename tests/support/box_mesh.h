// A box of cells, six tets (Kuhn's) each, with facets wherever a test wants them.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <vector>

#include "radiosity/enclosure.h"

namespace tyndall::test {

using mesh::Point;

// What lies on a cell's face: nothing, a wall or an interface. `plus`, `minus`: index into
// Enclosure::sides of the side that looks along the positive axis, and of the other.
struct Face {
    mesh::Opacity opacity = mesh::Opacity::opaque;
    std::uint32_t plus = radiosity::none, minus = radiosity::none;
};

// Face at `centre`, across `axis` (0 to 2).
using FaceAt = std::function<std::optional<Face>(Point centre, int axis)>;

inline void add_cells(mesh::BaseMesh& mesh, const std::array<std::vector<double>, 3>& lines) {
    const auto [nx, ny, nz] = std::array{lines[0].size(), lines[1].size(), lines[2].size()};
    for (double z : lines[2])
        for (double y : lines[1])
            for (double x : lines[0]) mesh.points.push_back({x, y, z});
    const std::array<std::array<int, 3>, 6> orders{
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
    for (std::size_t k = 0; k + 1 < nz; ++k)
        for (std::size_t j = 0; j + 1 < ny; ++j)
            for (std::size_t i = 0; i + 1 < nx; ++i)
                for (std::size_t o = 0; o < orders.size(); ++o) {
                    std::array<std::size_t, 3> at{i, j, k};
                    std::array<mesh::VertexId, 4> tet;
                    for (int corner = 0; corner < 4; ++corner) {
                        tet[corner] = mesh::VertexId(at[0] + nx * (at[1] + ny * at[2]));
                        if (corner < 3) ++at[orders[o][corner]];
                    }
                    if (o >= 3) std::swap(tet[1], tet[2]);  // odd orders run the other way
                    mesh.tets.push_back(tet);
                }
}

inline void add_topology(mesh::BaseMesh& mesh, const FaceAt& face_at,
                         std::vector<std::array<std::uint32_t, 2>>& facet_sides) {
    using Key = std::array<std::uint32_t, 3>;
    std::map<Key, std::vector<std::pair<std::size_t, int>>> faces;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
        for (int k = 0; k < 4; ++k) {
            Key key;
            for (int c = 0; c < 3; ++c) key[c] = mesh.tets[t][(k + 1 + c) % 4].value;
            std::sort(key.begin(), key.end());
            faces[key].push_back({t, k});
        }
    mesh.neighbours.resize(mesh.tets.size());
    mesh.tet_facets.resize(mesh.tets.size());
    for (const auto& [key, users] : faces) {
        if (users.size() == 2) {
            mesh.neighbours[users[0].first][users[0].second] = mesh::TetId(users[1].first);
            mesh.neighbours[users[1].first][users[1].second] = mesh::TetId(users[0].first);
        }
        std::array<mesh::VertexId, 3> ids{mesh::VertexId(key[0]), mesh::VertexId(key[1]),
                                          mesh::VertexId(key[2])};
        const Point a = mesh.points[key[0]], b = mesh.points[key[1]], c = mesh.points[key[2]];
        for (int axis = 0; axis < 3; ++axis) {
            if (a[axis] != b[axis] || a[axis] != c[axis]) continue;
            // The cell face's centre: the middle of the triangle's box.
            const auto low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
            const auto face = face_at(0.5 * (low + high), axis);
            if (!face) continue;
            if (glm::cross(b - a, c - a)[axis] < 0.0) std::swap(ids[1], ids[2]);
            mesh::BaseFacet facet{ids, mesh::FacetId(mesh.facets.size()), face->opacity, {}};
            for (const auto& [t, k] : users) {
                const bool plus = mesh.points[mesh.tets[t][k].value][axis] > a[axis];
                facet.tets[plus ? 0 : 1] = mesh::TetId(t);
                mesh.tet_facets[t][k] = mesh::FacetId(mesh.facets.size());
            }
            mesh.facets.push_back(facet);
            facet_sides.push_back({face->plus, face->minus});
        }
    }
}

inline void flood_regions(mesh::BaseMesh& mesh) {
    mesh.regions.assign(mesh.tets.size(), mesh::RegionId());
    for (std::size_t seed = 0; seed < mesh.tets.size(); ++seed) {
        if (mesh.regions[seed].valid()) continue;
        std::vector<std::size_t> open{seed};
        mesh.regions[seed] = mesh::RegionId(mesh.region_count);
        while (!open.empty()) {
            const std::size_t t = open.back();
            open.pop_back();
            for (int k = 0; k < 4; ++k) {
                const auto next = mesh.neighbours[t][k];
                if (!next.valid() || mesh.tet_facets[t][k].valid() ||
                    mesh.regions[next.value].valid())
                    continue;
                mesh.regions[next.value] = mesh::RegionId(mesh.region_count);
                open.push_back(next.value);
            }
        }
        ++mesh.region_count;
    }
}

// The grid's `lines` along x, y and z [m]. Regions are empty and not solid; sides, media and lights
// are the caller's to add.
inline radiosity::Enclosure box_enclosure(const std::array<std::vector<double>, 3>& lines,
                                          const FaceAt& face_at) {
    radiosity::Enclosure enclosure;
    auto& mesh = enclosure.mesh;
    add_cells(mesh, lines);
    add_topology(mesh, face_at, enclosure.facet_sides);
    flood_regions(mesh);
    for (int axis = 0; axis < 3; ++axis) {
        mesh.hull_min[axis] = lines[axis].front();
        mesh.hull_max[axis] = lines[axis].back();
    }
    enclosure.region_medium.assign(mesh.region_count, radiosity::none);
    enclosure.region_solid.assign(mesh.region_count, false);
    enclosure.environment = {0.0};
    return enclosure;
}

// The tet that x lies deepest in; of several at a face, one whose centre is towards `towards`.
inline mesh::TetId tet_at(const mesh::BaseMesh& mesh, Point x, mesh::Direction towards = {}) {
    x += 1e-9 * towards;
    mesh::TetId best;
    double depth = -1e300;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        const auto& tet = mesh.tets[t];
        double least = 1e300;
        for (int k = 0; k < 4; ++k) {
            const Point a = mesh.points[tet[(k + 1) % 4].value],
                        b = mesh.points[tet[(k + 2) % 4].value],
                        c = mesh.points[tet[(k + 3) % 4].value];
            const auto n = glm::normalize(glm::cross(b - a, c - a));
            const double height = glm::dot(n, mesh.points[tet[k].value] - a);
            least = std::min(least, glm::dot(n, x - a) * (height > 0.0 ? 1.0 : -1.0));
        }
        if (least > depth) depth = least, best = mesh::TetId(t);
    }
    return best;
}

}  // namespace tyndall::test
