// Where the cubes of an element stand, and how they are turned.
#pragma once

#include <glm/mat3x3.hpp>

#include "radiosity/exchange.h"
#include "radiosity/point_set.h"

namespace tyndall::radiosity {

struct CubeCentre {
    Point place{0};        // [m]
    mesh::WalkStart at{};  // where rays from it start
    glm::dmat3 axes{1};    // columns: the cube's x, y, z; z is a patch's normal
};

class CubeCentres {
  public:
    // Of settings.centres cubes an element, as rows_by_cubes says.
    CubeCentres(const Discretization& discretization, const ExchangeSettings& settings,
                std::uint64_t seed);

    std::size_t count() const { return points_.size(); }
    // Cost: O(members) for a centroid, O(log members) else.
    CubeCentre operator()(std::size_t element, std::size_t index) const;

  private:
    CubeCentre at_centroid(std::size_t element) const;
    CubeCentre at_point(std::size_t element, std::size_t index, std::uint64_t seed) const;
    CubeCentre on(std::size_t element, std::uint32_t member, Point place) const;

    const Discretization& d_;
    ExchangeSettings settings_;
    std::uint64_t seed_;
    PointSet points_;
};

}  // namespace tyndall::radiosity
