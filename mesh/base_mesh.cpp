#include "mesh/base_mesh.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

namespace tyndall::mesh {

namespace {

// The four face tests of x in a tet: six times the volume of x and the face opposite corner k,
// relative to the tet's own: its barycentric coordinates.
std::array<double, 4> barycentric(const BaseMesh& mesh, TetId tet, Point x) {
    const auto& corners = mesh.tets[tet.value];
    std::array<glm::dvec3, 4> p;
    for (int k = 0; k < 4; ++k) {
        p[k] = mesh.points[corners[k].value] - x;
    }
    const auto six_volumes = [](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        return glm::dot(glm::cross(a, b), c);
    };
    // Faces seen from x: inward orientation is that of a positive tet.
    std::array<double, 4> v{six_volumes(p[1], p[2], p[3]), six_volumes(p[0], p[3], p[2]),
                            six_volumes(p[0], p[1], p[3]), six_volumes(p[0], p[2], p[1])};
    const double sum = v[0] + v[1] + v[2] + v[3];
    for (auto& value : v) {
        value /= sum;
    }
    return v;
}

int least(const std::array<double, 4>& values) {
    return static_cast<int>(std::min_element(values.begin(), values.end()) - values.begin());
}

// The tet in which x is inside, or least outside: rounding leaves no tet at all for some points on
// faces.
TetId search(const BaseMesh& mesh, Point x) {
    TetId best;
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        const auto b = barycentric(mesh, TetId(t), x);
        if (const double inside = b[least(b)]; inside > most) {
            most = inside;
            best = TetId(t);
        }
    }
    return best;
}

}  // namespace

void find_regions(BaseMesh& mesh) {
    mesh.regions.assign(mesh.tets.size(), RegionId());
    mesh.region_count = 0;
    std::vector<TetId> open;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        if (mesh.regions[t].valid()) {
            continue;
        }
        const RegionId region(mesh.region_count++);
        mesh.regions[t] = region;
        open.push_back(TetId(t));
        while (!open.empty()) {
            const auto tet = open.back();
            open.pop_back();
            for (int k = 0; k < 4; ++k) {
                const auto next = mesh.neighbours[tet.value][k];
                if (next.valid() && !mesh.tet_facets[tet.value][k].valid() &&
                    !mesh.regions[next.value].valid()) {
                    mesh.regions[next.value] = region;
                    open.push_back(next);
                }
            }
        }
    }
}

TetId locate(const BaseMesh& mesh, Point x, TetId start) {
    const bool in_hull = x.x >= mesh.hull_min.x && x.y >= mesh.hull_min.y &&
                         x.z >= mesh.hull_min.z && x.x <= mesh.hull_max.x &&
                         x.y <= mesh.hull_max.y && x.z <= mesh.hull_max.z;
    if (!in_hull || mesh.tets.empty()) {  // a NaN is in no hull
        return {};
    }
    auto tet = start.valid() && start.value < mesh.tets.size() ? start : TetId(0);
    TetId from;
    for (std::size_t step = 0; step <= mesh.tets.size(); ++step) {
        auto b = barycentric(mesh, tet, x);
        for (int k = 0; k < 4; ++k) {  // remembering: never back through the face just crossed
            if (from.valid() && mesh.neighbours[tet.value][k] == from) {
                b[k] = std::max(b[k], 0.0);
            }
        }
        const int k = least(b);
        if (b[k] >= 0.0) {
            return tet;
        }
        const auto next = mesh.neighbours[tet.value][k];
        if (!next.valid()) {
            break;
        }
        from = tet;
        tet = next;
    }
    return search(mesh, x);
}

double volume(const BaseMesh& mesh, TetId tet) {
    const auto& corners = mesh.tets[tet.value];
    const auto& a = mesh.points[corners[0].value];
    return glm::dot(
               glm::cross(mesh.points[corners[1].value] - a, mesh.points[corners[2].value] - a),
               mesh.points[corners[3].value] - a) /
           6.0;
}

namespace {

glm::dvec3 area_vector(const BaseMesh& mesh, FacetId facet) {
    const auto& corners = mesh.facets[facet.value].corners;
    const auto& a = mesh.points[corners[0].value];
    return 0.5 * glm::cross(mesh.points[corners[1].value] - a, mesh.points[corners[2].value] - a);
}

}  // namespace

double area(const BaseMesh& mesh, FacetId facet) {
    return glm::length(area_vector(mesh, facet));
}

double diagonal(const BaseMesh& mesh) {
    return glm::distance(mesh.hull_min, mesh.hull_max);
}

Direction normal(const BaseMesh& mesh, FacetId facet) {
    const auto n = area_vector(mesh, facet);
    return n / glm::length(n);
}

}  // namespace tyndall::mesh
