#include "radiosity/moving_bodies.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <map>

#include "mesh/body.h"
#include "radiosity/compare_scenes.h"
#include "radiosity/enclosure_emissions.h"

namespace tyndall::radiosity {
namespace {

bool same_shape(const Surface& a, const Surface& b) {
    return std::equal(a.polygons.begin(), a.polygons.end(), b.polygons.begin(), b.polygons.end(),
                      [](const mesh::Polygon& p, const mesh::Polygon& q) {
                          return p.opacity == q.opacity && p.corners.size() == q.corners.size();
                      });
}

// Every corner turns the way that the polygon as a whole does.
bool convex(const std::vector<Point>& corners) {
    const std::size_t n = corners.size();
    Direction area(0.0);
    for (std::size_t k = 1; k + 1 < n; ++k)
        area += glm::cross(corners[k] - corners[0], corners[k + 1] - corners[0]);
    for (std::size_t k = 0; k < n; ++k) {
        const auto turn = glm::cross(corners[(k + 1) % n] - corners[k],
                                     corners[(k + 2) % n] - corners[(k + 1) % n]);
        if (glm::dot(turn, area) < -1e-12 * glm::dot(area, area)) return false;
    }
    return true;
}

// Triangles of all the surfaces, welded where corners are the same to the bit.
struct BodyTriangles {
    std::vector<Point> points;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::size_t> surface;  // of each triangle

    BodyTriangles(const Scene& scene, std::span<const std::size_t> surfaces) {
        const auto before = [](const Point& a, const Point& b) {
            return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
        };
        std::map<Point, std::uint32_t, decltype(before)> numbers(before);
        for (const std::size_t s : surfaces)
            for (const auto& polygon : scene.surfaces[s].polygons) {
                std::vector<std::uint32_t> ring;
                for (const Point& corner : polygon.corners) {
                    const auto next = static_cast<std::uint32_t>(points.size());
                    const auto [entry, made] = numbers.try_emplace(corner, next);
                    if (made) points.push_back(corner);
                    ring.push_back(entry->second);
                }
                for (std::size_t k = 1; k + 1 < ring.size(); ++k) {
                    triangles.push_back({ring[0], ring[k], ring[k + 1]});
                    surface.push_back(s);
                }
            }
    }

    // Of each point: the lowest one that it is connected with.
    std::vector<std::uint32_t> components() const {
        std::vector<std::uint32_t> root(points.size());
        for (std::size_t k = 0; k < root.size(); ++k) root[k] = static_cast<std::uint32_t>(k);
        const auto find = [&](std::uint32_t k) {
            while (root[k] != k) k = root[k] = root[root[k]];
            return k;
        };
        for (const auto& t : triangles)
            for (const auto corner : {t[1], t[2]}) {
                const auto [low, high] = std::minmax({find(t[0]), find(corner)});
                root[high] = low;
            }
        for (std::size_t k = 0; k < root.size(); ++k) root[k] = find(static_cast<std::uint32_t>(k));
        return root;
    }
};

// Adds the bodies; of each of their facets, in order, its surface.
std::vector<std::size_t> add_bodies(const BodyTriangles& shape, mesh::BaseMesh& mesh) {
    const auto component = shape.components();
    std::vector<std::size_t> surface;
    for (std::uint32_t c = 0; c < component.size(); ++c) {
        if (component[c] != c) continue;
        std::vector<Point> points;
        std::vector<std::uint32_t> number(shape.points.size());
        for (std::size_t k = 0; k < shape.points.size(); ++k)
            if (component[k] == c) {
                number[k] = static_cast<std::uint32_t>(points.size());
                points.push_back(shape.points[k]);
            }
        std::vector<std::array<std::uint32_t, 3>> triangles;
        for (std::size_t t = 0; t < shape.triangles.size(); ++t) {
            const auto& corners = shape.triangles[t];
            if (component[corners[0]] != c) continue;
            triangles.push_back({number[corners[0]], number[corners[1]], number[corners[2]]});
            surface.push_back(shape.surface[t]);
        }
        mesh::add_body(mesh, points, triangles);
    }
    return surface;
}

bool emits(const Material& material) {
    const auto any = [](const Spectrum& s) {
        return std::any_of(s.begin(), s.end(), [](double v) { return v != 0.0; });
    };
    return any(material.emission) || any(material.power) || !material.flux.empty();
}

bool mirrors(const Material& material) {
    return material.roughness == 0.0 &&
           std::any_of(material.specular.begin(), material.specular.end(),
                       [](double rho) { return rho > 0.0; });
}

// A body that holds a place from which or for which light is computed is no solid.
bool holds_a_place(const Scene& scene, const mesh::BaseMesh& mesh) {
    const auto inside = [&](Point x) { return mesh::body_around(mesh, x) != nullptr; };
    const auto light_inside = [&](const Light& light) {
        const auto* point = std::get_if<PointLight>(&light.source);
        const auto* spot = std::get_if<SpotLight>(&light.source);
        return (point && inside(point->position)) || (spot && inside(spot->position));
    };
    return std::ranges::any_of(scene.viewpoints, inside) ||
           std::ranges::any_of(scene.lights, light_inside) ||
           std::ranges::any_of(scene.media, [&](const Medium& m) { return m.at && inside(*m.at); });
}

}  // namespace

std::optional<std::vector<std::size_t>> moved_surfaces(const Scene& before, const Scene& after) {
    if (before.surfaces.size() != after.surfaces.size()) return {};
    Scene back = after;
    std::vector<std::size_t> moved;
    for (std::size_t s = 0; s < after.surfaces.size(); ++s) {
        const auto &a = before.surfaces[s].polygons, &b = after.surfaces[s].polygons;
        if (!same_shape(before.surfaces[s], after.surfaces[s])) return {};
        for (std::size_t p = 0; p < a.size(); ++p)
            if (a[p].corners != b[p].corners) {
                moved.push_back(s);
                break;
            }
        back.surfaces[s].polygons = a;
    }
    if (compare_scenes(before, back).change != SceneChange::nothing) return {};
    return moved;
}

Scene without_surfaces(const Scene& scene, std::span<const std::size_t> surfaces) {
    Scene still = scene;
    for (const std::size_t s : surfaces) still.surfaces[s].polygons.clear();
    return still;
}

std::string why_no_bodies(const Scene& scene, std::span<const std::size_t> surfaces,
                          const Enclosure& still) {
    if (still.thermal || still.settles()) return "is in a scene whose temperatures are found";
    if (still.has_mirrors()) return "is in a scene with mirrors";
    for (const std::size_t s : surfaces) {
        const Surface& surface = scene.surfaces[s];
        if (!surface.material) return "has no material: what it bounds may be another medium";
        for (const Side side : {Side::front, Side::back}) {
            const Material& material = *material_of_side(scene, s, side).material;
            if (emits(material)) return "emits";
            if (still.mirrors == Mirrors::walked && mirrors(material)) return "is a mirror";
        }
        for (const auto& polygon : surface.polygons) {
            if (!convex(polygon.corners)) return "has a polygon that is not convex";
            for (const Point& p : polygon.corners)
                for (int axis = 0; axis < 3; ++axis)
                    if (p[axis] < still.mesh.hull_min[axis] || p[axis] > still.mesh.hull_max[axis])
                        return "leaves the hull of what stands still";
        }
    }
    mesh::BaseMesh mesh = still.mesh;
    add_bodies(BodyTriangles(scene, surfaces), mesh);
    return holds_a_place(scene, mesh) ? "holds a camera, a light or the point of a medium" : "";
}

Enclosure with_bodies(const Enclosure& still, const Scene& scene,
                      std::span<const std::size_t> surfaces) {
    Enclosure e = still;
    const std::size_t first = e.mesh.facets.size();
    const auto surface = add_bodies(BodyTriangles(scene, surfaces), e.mesh);
    std::map<std::pair<std::size_t, Side>, std::uint32_t> sides;
    for (std::size_t f = first; f < e.mesh.facets.size(); ++f) {
        auto& of_facet = e.facet_sides.emplace_back(std::array{none, none});
        for (const Side side : {Side::front, Side::back}) {
            const TetId tet = e.mesh.facets[f].tets[side == Side::back];
            if (!tet.valid() || e.solid(tet)) continue;
            const auto [entry, made] = sides.try_emplace(
                {surface[f - first], side}, static_cast<std::uint32_t>(e.sides.size()));
            if (made) e.sides.push_back(side_of_surface(scene, e, surface[f - first], side));
            of_facet[side == Side::back] = entry->second;
            e.sides[entry->second].area += mesh::area(e.mesh, FacetId(f));
        }
    }
    bind_emissions(scene, e);
    return e;
}

std::vector<mesh::Body> bodies_of(const Enclosure& before, const Enclosure& now) {
    std::vector<mesh::Body> bodies = before.mesh.bodies;
    bodies.insert(bodies.end(), now.mesh.bodies.begin(), now.mesh.bodies.end());
    return bodies;
}

}  // namespace tyndall::radiosity
