// Low-discrepancy points: Sobol' sequences with Owen scrambling.
//
// Source: Sobol' (1967) with the direction numbers of Joe & Kuo (2008); Owen (1995); hashed nested
// uniform scrambling after Laine & Karras (2011) and Burley (2020).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/types.h"

namespace tyndall::radiosity {

// Three for a place in a tet, two for a direction.
inline constexpr std::size_t point_set_dimensions = 5;

// `count` points in the unit cube of five dimensions. Of any power of two, the first pair of
// dimensions is a (0, m, 2)-net and every other pair a (1, m, 2)-net: stratified to one and two
// points an elementary interval. Seeds give independent scramblings of the same set.
class PointSet {
  public:
    explicit PointSet(std::size_t count);
    std::size_t size() const { return points_.size(); }
    // Point `index` as scrambled by `seed`, every coordinate in [0, 1).
    std::array<double, point_set_dimensions> operator()(std::size_t index,
                                                        std::uint64_t seed) const;

  private:
    std::vector<std::array<std::uint32_t, point_set_dimensions>> points_;
};

// A 64-bit hash for seeds: independent streams for (seed, index).
std::uint64_t hash_seed(std::uint64_t seed, std::uint64_t index);

// Uniform on the unit sphere, from two numbers in [0, 1).
mesh::Direction uniform_direction(double u, double v);
// Cosine-weighted about the unit vector n: density cosθ/π.
mesh::Direction cosine_direction(mesh::Direction n, double u, double v);
// Barycentric weights of uniform points in a triangle and in a tetrahedron.
std::array<double, 3> uniform_in_triangle(double u, double v);
std::array<double, 4> uniform_in_tet(double u, double v, double w);

}  // namespace tyndall::radiosity
