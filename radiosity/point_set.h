// Points for sampled methods: Sobol' sequences with Owen scrambling, stratified or independent
// points.
//
// Source: Sobol' (1967) with the direction numbers of Joe & Kuo (2008); Owen (1995); hashed nested
// uniform scrambling after Laine & Karras (2011) and Burley (2020). Stratified: jittered sampling,
// Cook (1986); permutations by hashing, Kensler (2013).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/types.h"
#include "radiosity/options.h"

namespace tyndall::radiosity {

// Three for a place in a tet, two for a direction.
inline constexpr std::size_t point_set_dimensions = 5;

// `count` points in the unit cube of five dimensions. Seeds give independent sets. Over the
// seeds the points together are uniform, so that means over all of them are unbiased.
//   sobol        Of any power of two, the first pair of dimensions is a (0, m, 2)-net and every
//                other pair a (1, m, 2)-net: stratified to one and two points an elementary
//                interval. Seeds give independent scramblings of the same set.
//   stratified   The pairs (0, 1) of a place and (3, 4) of a direction are cut into cells together:
//                a grid of four dimensions of as many cells as `count` allows, as even as that
//                allows, one point anywhere in each; points beyond that are anywhere. Dimension 2,
//                which only places in zones have, is cut into `count` strata by itself, a point in
//                each. Integrands with jumps converge as count^−5/8, smooth ones as count^−3/4,
//                but for what dimension 2 does together with others.
//   independent  Every point anywhere: count^−1/2, the yardstick.
class PointSet {
  public:
    explicit PointSet(std::size_t count, PointSetKind kind = PointSetKind::sobol);
    std::size_t size() const { return count_; }
    // Point `index` as scrambled by `seed`, every coordinate in [0, 1).
    std::array<double, point_set_dimensions> operator()(std::size_t index,
                                                        std::uint64_t seed) const;

  private:
    using Numbers = std::array<double, point_set_dimensions>;

    Numbers sobol(std::size_t index, std::uint64_t seed) const;
    Numbers stratified(std::size_t index, std::uint64_t seed) const;

    PointSetKind kind_;
    std::size_t count_;
    std::vector<std::array<std::uint32_t, point_set_dimensions>> points_;  // sobol
    std::array<std::size_t, 4> cells_{1, 1, 1, 1};  // along dimensions 0, 1, 3 and 4: stratified
};

// A 64-bit hash for seeds: independent streams for (seed, index).
std::uint64_t hash_seed(std::uint64_t seed, std::uint64_t index);

// The upper 53 of 64 bits as a number in [0, 1).
inline double unit_number(std::uint64_t bits) {
    return static_cast<double>(bits >> 11) * 0x1p-53;
}

// Uniform on the unit sphere, from two numbers in [0, 1).
mesh::Direction uniform_direction(double u, double v);
// Cosine-weighted about the unit vector n: density cosθ/π.
mesh::Direction cosine_direction(mesh::Direction n, double u, double v);
// The direction at an angle of the given cosine about a unit axis, turned by v of a full turn.
mesh::Direction direction_about(mesh::Direction axis, double cosine, double v);
// Barycentric weights of uniform points in a triangle and in a tetrahedron.
std::array<double, 3> uniform_in_triangle(double u, double v);
std::array<double, 4> uniform_in_tet(double u, double v, double w);

}  // namespace tyndall::radiosity
