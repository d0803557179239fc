// Polygons that the geometry tests are built from.
#pragma once

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "mesh/base_mesh.h"
#include "mesh/conform.h"
#include "mesh/polygon.h"

namespace geometry {

using namespace tyndall::mesh;

using Polygons = std::vector<Polygon>;

inline Polygon polygon(std::vector<Point> corners, std::string name,
                       Opacity opacity = Opacity::opaque) {
    return {std::move(corners), opacity, std::move(name)};
}

// The parallelogram corner + s u + t v; front = u × v.
inline Polygon sheet(Point corner, glm::dvec3 u, glm::dvec3 v, std::string name,
                     Opacity opacity = Opacity::opaque) {
    return polygon({corner, corner + u, corner + u + v, corner + v}, std::move(name), opacity);
}

// The parallelepiped on three edges, fronts outward.
inline void add_block(Polygons& to, Point at, glm::dvec3 u, glm::dvec3 v, glm::dvec3 w,
                      const std::string& name) {
    to.push_back(sheet(at, v, u, name + ".bottom"));
    to.push_back(sheet(at + w, u, v, name + ".top"));
    to.push_back(sheet(at, u, w, name + ".y0"));
    to.push_back(sheet(at + v, w, u, name + ".y1"));
    to.push_back(sheet(at, w, v, name + ".x0"));
    to.push_back(sheet(at + u, v, w, name + ".x1"));
}

inline void add_box(Polygons& to, Point low, Point high, const std::string& name) {
    const auto e = high - low;
    add_block(to, low, {e.x, 0, 0}, {0, e.y, 0}, {0, 0, e.z}, name);
}

// As a box, fronts inward.
inline void add_room(Polygons& to, Point low, Point high, const std::string& name) {
    const auto first = to.size();
    add_box(to, low, high, name);
    for (auto i = first; i < to.size(); ++i) {
        std::swap(to[i].corners[1], to[i].corners[3]);
    }
}

inline double area_of(const std::vector<Point>& corners) {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
        sum += glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    }
    return 0.5 * glm::length(sum);
}

inline double area_of(const ConformingComplex& complex, const ConformingFacet& facet) {
    return area_of({complex.points[facet.corners[0].value], complex.points[facet.corners[1].value],
                    complex.points[facet.corners[2].value]});
}

// The area of the facets on each polygon.
inline std::vector<double> areas_by_polygon(const ConformingComplex& complex, std::size_t count) {
    std::vector<double> areas(count, 0.0);
    for (const auto& facet : complex.facets) {
        for (const auto id : facet.polygons) {
            areas[id.value] += area_of(complex, facet);
        }
    }
    return areas;
}

// The area of polygon's sides that facets give to it: [its front, its back].
inline std::array<double, 2> owned(const ConformingComplex& complex, std::size_t polygon) {
    std::array<double, 2> areas{0.0, 0.0};
    for (const auto& facet : complex.facets) {
        for (const auto& owner : {facet.front, facet.back}) {
            if (owner.polygon == PolygonId(polygon)) {
                areas[static_cast<int>(owner.side)] += area_of(complex, facet);
            }
        }
    }
    return areas;
}

// A 5 × 4 × 3 room with six openings, a box on its floor and an emitter outside.
inline Polygons lit_room() {
    Polygons scene;
    add_room(scene, {0, 0, 0}, {5, 4, 3}, "room");
    for (int i = 0; i < 6; ++i) {
        scene.push_back(sheet({0, 0.5 + 1.2 * (i % 3), 0.8 + 1.0 * (i / 3)}, {0, 0.5, 0},
                              {0, 0, 0.5}, "window", Opacity::interface));
    }
    add_box(scene, {2, 1.5, 0}, {2.75, 2.25, 0.75}, "box");
    scene.push_back(sheet({-4, 1.8, 2}, {0, 0.4, 0}, {0, 0, 0.4}, "lamp"));
    return scene;
}

}  // namespace geometry
