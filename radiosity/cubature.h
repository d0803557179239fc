// Cubature rules on triangles and tetrahedra.
#pragma once

#include <array>
#include <span>

namespace tyndall::radiosity {

// A node's barycentric weights (the fourth is 0 in a triangle) and its share of the integral.
struct CubatureNode {
    std::array<double, 4> at;
    double weight;  // they add up to 1 [-]
};

// What polynomials a rule integrates exactly.
enum class Degree { one, two, five };

// Nodes inside the simplex, weights positive: 1, 3, 7 nodes.
// Source: Radon (1948) for degree 5.
std::span<const CubatureNode> triangle_rule(Degree degree);

// 1, 4, 14 nodes. Source: Walkington (2000) for degree 5.
std::span<const CubatureNode> tet_rule(Degree degree);

}  // namespace tyndall::radiosity
