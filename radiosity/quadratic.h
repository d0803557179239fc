// Quadratic functions on tets and triangles, from values at corners and at the middles of edges.
#pragma once

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "mesh/types.h"

namespace tyndall::radiosity {

// Quadratic Lagrange functions of a tet (n = 4) or triangle at the place with these barycentric
// coordinates: λ_i (2 λ_i − 1) of the corners, then 4 λ_i λ_j of the edges (0,1), (0,2), ….
template <std::size_t n>
std::array<double, n*(n + 1) / 2> lagrange(const std::array<double, n>& w) {
    std::array<double, n*(n + 1) / 2> phi;
    std::size_t edge = n;
    for (std::size_t i = 0; i < n; ++i) {
        phi[i] = w[i] * (2.0 * w[i] - 1.0);
        for (std::size_t j = i + 1; j < n; ++j) phi[edge++] = 4.0 * w[i] * w[j];
    }
    return phi;
}

// What the linear function nearest to a tet's values leaves of them: its corners, the middles of
// its edges and its centroid, eleven for four numbers.
//   Σ_k (Σ_i λ_i(x_k) h_i − f_k)² → min:  Σ_k λ λᵀ = (a − b) 1 + b 11ᵀ
inline double squares_left(const std::array<double, 4>& corners,
                           const std::array<double, 6>& middles, double centroid) {
    constexpr double a = 1.0 + 3.0 / 4.0 + 1.0 / 16.0, b = 1.0 / 4.0 + 1.0 / 16.0;
    std::array<double, 4> h;
    for (int i = 0; i < 4; ++i) h[i] = corners[i] + 0.25 * centroid;
    for (int i = 0, e = 0; i < 4; ++i)
        for (int j = i + 1; j < 4; ++j, ++e) {
            h[i] += 0.5 * middles[e];
            h[j] += 0.5 * middles[e];
        }
    const double sum = (h[0] + h[1] + h[2] + h[3]) / (a + 3.0 * b);
    const auto square = [](double x) { return x * x; };
    double left = square(0.25 * sum - centroid);
    for (double& v : h) v = (v - b * sum) / (a - b);
    for (int i = 0, e = 0; i < 4; ++i) {
        left += square(h[i] - corners[i]);
        for (int j = i + 1; j < 4; ++j, ++e) left += square(0.5 * (h[i] + h[j]) - middles[e]);
    }
    return left;
}

// The quadratic through values at an element's corners and at the middle of each edge (i, j), i <
// j, in the order (0,1), (0,2), …; continuous from element to element where they share edges.
//   f = Σ_i λ_i (2 λ_i − 1) f_i + Σ_{i<j} 4 λ_i λ_j f_ij,   λ the barycentric coordinates
// Four corners: a tet; three: a triangle. Valid for: elements that are not flat (else the mean of
// all values). Source: Zienkiewicz & Taylor, quadratic Lagrange elements.
template <std::size_t corners>
struct Quadratic {
    static constexpr std::size_t edges = corners * (corners - 1) / 2;
    std::array<mesh::Point, corners> points;
    std::array<double, corners> at_corners;
    std::array<double, edges> at_middles;

    double at(mesh::Point x) const {
        const auto w = barycentric(x);
        if (!std::isfinite(w[0])) return mean();
        const auto phi = lagrange(w);
        double sum = 0.0;
        for (std::size_t i = 0; i < corners; ++i) sum += phi[i] * at_corners[i];
        for (std::size_t e = 0; e < edges; ++e) sum += phi[corners + e] * at_middles[e];
        return sum;
    }

    // Over the element: exact for the quadratic.
    double mean() const {
        double at_ends = 0.0, between = 0.0;
        for (const double v : at_corners) at_ends += v;
        for (const double v : at_middles) between += v;
        return corners == 4 ? 0.2 * between - 0.05 * at_ends : between / 3.0;
    }

  private:
    std::array<double, corners> barycentric(mesh::Point x) const {
        std::array<double, corners> w;
        const auto u = points[1] - points[0], v = points[2] - points[0], p = x - points[0];
        const auto n = glm::cross(u, v);
        if constexpr (corners == 4) {
            const auto t = points[3] - points[0];
            const double volume = glm::dot(n, t);
            w[1] = glm::dot(glm::cross(v, t), p) / volume;
            w[2] = glm::dot(glm::cross(t, u), p) / volume;
            w[3] = glm::dot(n, p) / volume;
            w[0] = 1.0 - w[1] - w[2] - w[3];
        } else {
            const double square = glm::dot(n, n);
            w[1] = glm::dot(glm::cross(p, v), n) / square;
            w[2] = glm::dot(glm::cross(u, p), n) / square;
            w[0] = 1.0 - w[1] - w[2];
        }
        return w;
    }
};

}  // namespace tyndall::radiosity
