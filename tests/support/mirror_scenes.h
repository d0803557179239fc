// Scenes with perfect mirrors, and what stands in their place.
#pragma once

#include "support/rooms.h"

namespace tyndall::test {

// Reflects evenly and as a mirror.
inline radiosity::Material mirror(double specular, double reflectance = 0.0) {
    radiosity::Material m = material(reflectance);
    m.specular = {specular};
    return m;
}

// A foggy box of 1 × 1 × 1 m, a lamp in its ceiling and a grey block on its floor, whose wall x = 1
// is a perfect mirror; or (doubled) the box of 2 × 1 × 1 m that the mirror shows.
inline radiosity::Scene mirrored_box(bool doubled, double extinction = 0.5) {
    radiosity::Scene scene;
    scene.materials = {material(0.5), material(0.0, 10.0), mirror(1.0), material(0.8)};
    add_surfaces(scene, "room", mesh::room({0, 0, 0}, {doubled ? 2.0 : 1.0, 1, 1}), 0);
    if (!doubled) scene.surfaces[surface_named(scene, "room.x1")].material = 2;
    scene.surfaces[surface_named(scene, "room.floor")].material = 3;
    add_surfaces(scene, "lamp", mesh::rectangle({0.2, 0.3, 1}, {0, 0.4, 0}, {0.3, 0, 0}), 1);
    if (doubled)
        add_surfaces(scene, "image", mesh::rectangle({1.5, 0.3, 1}, {0, 0.4, 0}, {0.3, 0, 0}), 1);
    scene.media = {medium(extinction, 0.8)};
    return scene;
}

}  // namespace tyndall::test
