// Where rays from a point enter the mesh.
#pragma once

#include "mesh/walk.h"

namespace tyndall::mesh {

struct Entry {
    TetId tet;              // invalid: the ray misses the hull
    double distance = 0.0;  // along the ray, to just inside the hull [m]
};

// The tet that holds the ray's origin, `at_origin`, if that is valid; else the one behind the point
// where the ray meets the hull. Cost: that of `locate` from outside.
Entry entry_of(const BaseMesh& mesh, const Ray& ray, TetId at_origin);

// The same for a ray that begins near x, whose tet `at_x` is known (invalid: outside the hull).
Entry entry_near(const BaseMesh& mesh, const Ray& ray, Point x, TetId at_x);

}  // namespace tyndall::mesh
