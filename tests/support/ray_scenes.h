// Scenes that the walk and the forest are tested in.
#pragma once

#include "mesh/conform.h"
#include "mesh/geometry.h"
#include "mesh/tetrahedralize.h"
#include "support/random_rays.h"

namespace tyndall::test {

struct RayScene {
    std::string name;
    geometry::Polygons polygons;
};

// 64 boxes, each turned by an angle of its own, that stand 5 cm deep in a floor.
inline geometry::Polygons rotated_boxes() {
    geometry::Polygons scene;
    geometry::add_room(scene, {0, 0, 0}, {10, 10, 4}, "room");
    Random random(64);
    for (int i = 0; i < 64; ++i) {
        const double angle = uniform(random, 0.0, 6.28), size = uniform(random, 0.3, 0.6);
        const mesh::Point at(1.0 + 1.1 * (i % 8), 1.0 + 1.1 * (i / 8), i % 2 ? 0.0 : 0.7);
        const glm::dvec3 u(size * std::cos(angle), size * std::sin(angle), 0.0);
        const glm::dvec3 v(-u.y, u.x, 0.0);
        geometry::add_block(scene, at - 0.5 * (u + v), u, v, {0, 0, uniform(random, 0.2, 1.5)},
                            "box" + std::to_string(i));
    }
    return scene;
}

// A room with a partition of no thickness, and a slit in it; an interface closes half of the slit.
inline geometry::Polygons partition_with_slit() {
    using geometry::sheet;
    geometry::Polygons scene;
    geometry::add_room(scene, {0, 0, 0}, {4, 3, 3}, "room");
    scene.push_back(sheet({2, 0, 0}, {0, 1.45, 0}, {0, 0, 3}, "left"));
    scene.push_back(sheet({2, 1.55, 0}, {0, 1.45, 0}, {0, 0, 3}, "right"));
    scene.push_back(
        sheet({2, 1.45, 0}, {0, 0.1, 0}, {0, 0, 1.5}, "slit", mesh::Opacity::interface));
    scene.push_back(sheet({0.5, 1, 2.9}, {0.5, 0, 0}, {0, 1, 0}, "lamp"));
    geometry::add_block(scene, {2.5, 0.5, 0.5}, {1, 0.3, 0}, {-0.3, 1, 0}, {0, 0.2, 1.5}, "fog");
    for (std::size_t i = scene.size() - 6; i < scene.size(); ++i)
        scene[i].opacity = mesh::Opacity::interface;
    return scene;
}

inline void add_icosphere(geometry::Polygons& to, mesh::Point centre, double radius,
                          mesh::Opacity opacity) {
    using geometry::Point;
    const double g = 0.5 * (1.0 + std::sqrt(5.0));
    const std::vector<Point> p{{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                               {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                               {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    const int faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                              {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                              {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                              {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    const auto on = [&](Point x) { return centre + radius * glm::normalize(x); };
    const auto add = [&](Point a, Point b, Point c) {
        to.push_back(geometry::polygon({on(a), on(b), on(c)}, "ball", opacity));
    };
    for (const auto& f : faces) {
        const Point a = glm::normalize(p[f[0]]), b = glm::normalize(p[f[1]]),
                    c = glm::normalize(p[f[2]]);
        add(a, a + b, a + c), add(b, b + c, a + b), add(c, a + c, b + c), add(a + b, b + c, a + c);
    }
}

// Balls that cut each other and the walls, every third one of fog.
inline geometry::Polygons icosphere_soup() {
    geometry::Polygons scene;
    geometry::add_room(scene, {0, 0, 0}, {3, 3, 3}, "room");
    Random random(7);
    for (int i = 0; i < 12; ++i) {
        const mesh::Point centre(uniform(random, 0.2, 2.8), uniform(random, 0.2, 2.8),
                                 uniform(random, 0.2, 2.8));
        add_icosphere(scene, centre, uniform(random, 0.2, 0.6),
                      i % 3 ? mesh::Opacity::opaque : mesh::Opacity::interface);
    }
    return scene;
}

// Louvres of 2 mm before an opening.
inline geometry::Polygons thin_slats() {
    geometry::Polygons scene;
    geometry::add_room(scene, {0, 0, 0}, {3, 2, 2.5}, "room");
    for (int i = 0; i < 20; ++i)
        geometry::add_block(scene, {0.2, 0.3, 0.3 + 0.09 * i}, {0.06, 0, -0.05}, {0, 1.4, 0},
                            {0.0013, 0, 0.0015}, "slat");
    scene.push_back(geometry::sheet({0.1, 0.3, 0.3}, {0, 1.4, 0}, {0, 0, 1.9}, "opening",
                                    mesh::Opacity::interface));
    return scene;
}

inline std::vector<RayScene> ray_scenes() {
    return {{"room with openings, box and lamp", geometry::lit_room()},
            {"64 rotated boxes", rotated_boxes()},
            {"partition with a slit", partition_with_slit()},
            {"icosphere soup", icosphere_soup()},
            {"thin slats", thin_slats()}};
}

inline mesh::BaseMesh mesh_of(const RayScene& scene) {
    return mesh::tetrahedralize(mesh::conform(scene.polygons), scene.polygons);
}

}  // namespace tyndall::test
