// A room with something of everything that a path tracer's scene holds.
#pragma once

#include <numbers>

#include "mesh/input_error.h"
#include "support/catch.h"
#include "support/path_scenes.h"

namespace tyndall::test {

// Fog in a room of 3 × 2 × 2 m with a window, clear air outside; a screen that glows on both
// sides, walls black from behind, a mirror and a glossy wall; sun, point and spot lights.
inline radiosity::Scene rich_room() {
    radiosity::Scene scene;
    scene.title = "Rich <room> & \"more\"";
    auto wall = material(0.6);
    wall.back = 1;
    auto glow = material(0.3, 2.0);
    glow.emits = radiosity::EmittingSides::both;
    auto gloss = material(0.2);
    gloss.specular = {0.4};
    gloss.roughness = 0.3;
    auto mirror = material(0.0);
    mirror.specular = {0.9};
    scene.materials = {wall, material(0.0), glow, gloss, mirror};
    scene.materials[1].name = "soot";
    add_surfaces(scene, "room", mesh::room({0, 0, 0}, {3, 2, 2}), 0);
    scene.surfaces[surface_named(scene, "room.y0")].material = 3;
    scene.surfaces[surface_named(scene, "room.y1")].material = 4;
    add_surfaces(scene, "screen", mesh::rectangle({1.5, 0.5, 0.5}, {0, 1, 0}, {0, 0, 1}), 2);
    add_surfaces(scene, "block", mesh::box({2.2, 0.4, 0}, {2.7, 0.9, 0.6}), 0);
    add_surfaces(scene, "bank", mesh::box({0.3, 0.3, 0.3}, {0.9, 0.9, 0.9}), {});
    scene.media = {medium(0.4, 0.8, mesh::Point(1.2, 1.0, 1.0)),
                   medium(1.5, 0.9, mesh::Point(0.6, 0.6, 0.6))};
    scene.media[0].asymmetry = 0.7;
    scene.media[1].name = "thick bank";
    scene.lights = {
        {"sun", radiosity::Sun{{0.6, 0.0, -0.8}, {100.0}, 0.01}, ""},
        {"beam", radiosity::Sun{{0.0, 0.6, -0.8}, {50.0}, 0.0}, ""},
        {"bulb", radiosity::PointLight{{1.0, 1.0, 1.8}, {3.0}}, ""},
        {"spot", radiosity::SpotLight{{2.0, 1.0, 1.8}, {0, 0, -1}, {5.0}, 0.5, 0.1}, ""}};
    scene.environment = {0.25};
    return scene;
}

inline render::Camera rich_camera() {
    return camera_at({0.2, 0.4, 1.0}, {3.0, 1.2, 0.8}, 1.2, 32, 24);
}

}  // namespace tyndall::test
