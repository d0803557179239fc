// The four face planes of a base tetrahedron, to tell cheaply that a step stays in it.
#pragma once

#include <glm/geometric.hpp>

#include "mesh/walk.h"

namespace tyndall::mesh {

// Valid for: steps that begin in the tet or on its rim.
// Cost: four dot products a step, where a walk sets up a frame first.
class TetPlanes {
  public:
    TetPlanes() = default;
    TetPlanes(const BaseMesh& mesh, TetId tet) {
        const auto& corners = mesh.tets[tet.value];
        for (std::size_t k = 0; k < face_corners.size(); ++k) {
            const auto point = [&](int j) {
                return mesh.points[corners[face_corners[k][j]].value];
            };
            outward_[k] = glm::cross(point(1) - point(0), point(2) - point(0));
            offset_[k] = glm::dot(outward_[k], point(0));
        }
    }

    // Whether x + step is this side of every face that the step leads towards. No: perhaps, a walk
    // tells.
    bool keep(Point x, Direction step) const {
        for (std::size_t k = 0; k < outward_.size(); ++k) {
            const double towards = glm::dot(outward_[k], step);
            if (towards > 0.0 && !(glm::dot(outward_[k], x) + towards < offset_[k])) return false;
        }
        return true;
    }

  private:
    std::array<Direction, 4> outward_{};  // twice the faces' areas long [m^2]
    std::array<double, 4> offset_{};      // dot(outward, p) of a plane's points p [m^3]
};

}  // namespace tyndall::mesh
