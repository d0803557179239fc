#include "radiosity/element_faces.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <map>

namespace tyndall::radiosity {
namespace {

using Corners = std::array<VertexId, 3>;

// Triangles that may be merged, if they lie in one plane.
struct Group {
    std::vector<Corners> triangles;
    bool open = false;
    TetId front, back;
};

std::vector<ElementFace> merged(const Forest& forest, const Group& group, double tolerance) {
    // The merge wants points of its own, few of the forest's.
    std::map<VertexId, VertexId> numbers;
    std::vector<Point> points;
    auto triangles = group.triangles;
    for (Corners& corners : triangles)
        for (VertexId& corner : corners) {
            const auto [entry, made] = numbers.try_emplace(corner, VertexId(points.size()));
            if (made) points.push_back(forest.point(corner));
            corner = entry->second;
        }
    std::vector<ElementFace> faces;
    for (auto& polygon : mesh::convex_merge(points, triangles, mesh::Facing::kept, tolerance))
        faces.push_back({std::move(polygon), group.open, group.front, group.back});
    return faces;
}

std::vector<ElementFace> merged(const Forest& forest, const std::vector<Group>& groups,
                                double tolerance) {
    std::vector<ElementFace> all;
    for (const Group& group : groups)
        for (auto& face : merged(forest, group, tolerance)) all.push_back(std::move(face));
    return all;
}

// The face of a base tet that all three vertices lie in, by the corner opposite; none: 4.
int base_face(const Discretization& d, TetId tet, const Corners& corners) {
    const auto& base = d.enclosure.mesh.tets[tet.value];
    for (int k = 0; k < 4; ++k) {
        const bool on_face = std::ranges::none_of(corners, [&](VertexId corner) {
            const auto& carrier = d.forest.carrier(corner);
            return std::ranges::find(carrier, base[k]) != carrier.end();
        });
        if (on_face) return k;
    }
    return 4;
}

class ZoneBoundary {
  public:
    explicit ZoneBoundary(const Discretization& d) : d_(d) {}

    void add(ZoneId zone) {
        const auto& corners = d_.forest[zone].corners;
        const TetId tet = d_.forest.base_tet(zone);
        for (const auto& [a, b, c] : mesh::face_corners)
            add({corners[a], corners[b], corners[c]}, tet);
    }

    std::vector<Group> groups() const {
        std::map<std::pair<bool, std::uint32_t>, Group> groups;
        for (const auto& [key, face] : faces_) {
            // What two members share is no boundary, unless a wall stands there.
            if (face.count == 2 && face.open) continue;
            for (std::size_t k = 0; k < face.count; ++k) {
                const TetId beyond = face.open ? face.beyond : TetId();
                const auto medium = beyond.valid() ? d_.enclosure.medium_of(beyond) : none;
                Group& group = groups[{face.open, medium}];
                group.open = face.open;
                group.back = face.inside[k];
                group.front = beyond;
                group.triangles.push_back(face.corners[k]);
            }
        }
        std::vector<Group> result;
        for (auto& [key, group] : groups) result.push_back(std::move(group));
        return result;
    }

  private:
    struct Face {
        std::size_t count = 0;
        bool open = true;
        TetId beyond;
        std::array<TetId, 2> inside;
        std::array<Corners, 2> corners;
    };

    void add(const Corners& corners, TetId tet) {
        Corners key = corners;
        std::ranges::sort(key);
        Face& face = faces_[key];
        const int k = base_face(d_, tet, corners);
        face.beyond = k == 4 ? tet : d_.enclosure.mesh.neighbours[tet.value][k];
        const FacetId facet = k == 4 ? FacetId() : d_.enclosure.mesh.tet_facets[tet.value][k];
        face.open = face.beyond.valid() &&
                    !(facet.valid() &&
                      d_.enclosure.mesh.facets[facet.value].opacity == mesh::Opacity::opaque);
        face.inside[face.count] = tet;
        face.corners[face.count++] = corners;
    }

    const Discretization& d_;
    std::map<Corners, Face> faces_;
};

std::vector<Group> groups_of(const std::map<std::uint32_t, Group>& by_medium) {
    std::vector<Group> groups;
    for (const auto& [medium, group] : by_medium) groups.push_back(group);
    return groups;
}

// By medium, so that a face has one in front.
std::vector<Group> patch_groups(const Discretization& d, std::span<const std::uint32_t> members) {
    std::map<std::uint32_t, Group> groups;
    for (const std::uint32_t member : members) {
        const PatchId patch(member);
        const std::uint32_t side = d.forest.base_facet_side(patch);
        const TetId front = d.enclosure.mesh.facets[side / 2].tets[side % 2];
        Group& group = groups[d.enclosure.medium_of(front)];
        group.front = front;
        group.triangles.push_back(d.forest[patch].corners);
    }
    return groups_of(groups);
}

// As well by medium.
std::vector<Group> hull_groups(const Enclosure& enclosure) {
    const auto& mesh = enclosure.mesh;
    std::map<std::uint32_t, Group> groups;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        const TetId tet(t);
        if (enclosure.solid(tet)) continue;
        for (int k = 0; k < 4; ++k) {
            const FacetId facet = mesh.tet_facets[t][k];
            if (mesh.neighbours[t][k].valid() ||
                (facet.valid() && mesh.facets[facet.value].opacity == mesh::Opacity::opaque))
                continue;
            const auto& [a, b, c] = mesh::face_corners[k];
            Group& group = groups[enclosure.medium_of(tet)];
            group.front = tet;
            group.triangles.push_back({mesh.tets[t][a], mesh.tets[t][c], mesh.tets[t][b]});
        }
    }
    return groups_of(groups);
}

}  // namespace

double plane_tolerance(const Enclosure& enclosure) {
    return 1e-9 * glm::distance(enclosure.mesh.hull_min, enclosure.mesh.hull_max);
}

std::vector<ElementFace> faces_of(const Discretization& d, ElementId element) {
    const double tolerance = plane_tolerance(d.enclosure);
    if (element.value == d.elements.outside())
        return merged(d.forest, hull_groups(d.enclosure), tolerance);
    const auto members = d.elements.members_of(element.value);
    if (d.elements.is_patch(element.value))
        return merged(d.forest, patch_groups(d, members), tolerance);
    ZoneBoundary boundary(d);
    for (const std::uint32_t member : members) boundary.add(ZoneId(member));
    return merged(d.forest, boundary.groups(), tolerance);
}

std::vector<mesh::ConvexPolygon> occluding_polygons(const Enclosure& enclosure, double tolerance) {
    const auto active = [&](TetId tet) { return tet.valid() && !enclosure.solid(tet); };
    std::vector<Corners> triangles;
    for (const auto& facet : enclosure.mesh.facets)
        if (facet.opacity == mesh::Opacity::opaque &&
            (active(facet.tets[0]) || active(facet.tets[1])))
            triangles.push_back(facet.corners);
    return mesh::convex_merge(enclosure.mesh.points, triangles, mesh::Facing::ignored, tolerance);
}

std::vector<mesh::ConvexPolygon> media_interfaces(const Enclosure& enclosure) {
    const auto differ = [&](TetId a, TetId b) {
        for (std::size_t band = 0; band < enclosure.bands; ++band)
            if (enclosure.extinction(a, band) != enclosure.extinction(b, band)) return true;
        return false;
    };
    std::vector<Corners> triangles;
    for (const auto& facet : enclosure.mesh.facets)
        if (facet.opacity == mesh::Opacity::interface && facet.tets[0].valid() &&
            facet.tets[1].valid() && differ(facet.tets[0], facet.tets[1]))
            triangles.push_back(facet.corners);
    return mesh::convex_merge(enclosure.mesh.points, triangles, mesh::Facing::ignored,
                              plane_tolerance(enclosure));
}

}  // namespace tyndall::radiosity
