#include "radiosity/contour.h"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

namespace tyndall::radiosity {
namespace {

using mesh::Direction;
using mesh::Point;

struct Edge {
    Point from;
    Direction along;  // unit
    double length;

    Point at(double l) const { return from + l * along; }
};

std::vector<Edge> edges_of(std::span<const Point> polygon) {
    std::vector<Edge> edges;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const auto way = polygon[k + 1 == polygon.size() ? 0 : k + 1] - polygon[k];
        if (const double length = glm::length(way); length > 0.0)
            edges.push_back({polygon[k], way / length, length});
    }
    return edges;
}

// ∫ ln s dl over an edge from a point that is l before the edge's start and d beside its line.
double inner(double l, double length, double d) {
    const auto antiderivative = [d](double x) {
        const double s = std::hypot(x, d);
        if (s == 0.0) return 0.0;
        return x * std::log(s) - x + (d > 0.0 ? d * std::atan2(x, d) : 0.0);
    };
    return antiderivative(l + length) - antiderivative(l);
}

double inner(const Edge& edge, Point x) {
    const auto way = edge.from - x;
    const double l = glm::dot(way, edge.along);
    return inner(l, edge.length, glm::length(way - l * edge.along));
}

// Where on p the integrand is not smooth, or nearly: beside q's ends, and nearest to q's line.
std::vector<double> breaks(const Edge& p, const Edge& q) {
    std::vector<double> at{0.0, p.length, glm::dot(q.from - p.from, p.along),
                           glm::dot(q.at(q.length) - p.from, p.along)};
    const double across = glm::dot(p.along, q.along);
    if (const double square = 1.0 - across * across; square > 1e-12) {
        const auto way = q.from - p.from;
        at.push_back((glm::dot(way, p.along) - across * glm::dot(way, q.along)) / square);
    }
    for (double& l : at) l = std::clamp(l, 0.0, p.length);
    std::ranges::sort(at);
    // Places that differ by rounding are one.
    const auto same = [&](double a, double b) { return b - a <= 1e-13 * p.length; };
    at.erase(std::unique(at.begin(), at.end(), same), at.end());
    at.back() = p.length;
    return at;
}

double double_integral(const Edge& p, const Edge& q) {
    thread_local boost::math::quadrature::tanh_sinh<double> quadrature(12);  // grows its tables
    const auto at = breaks(p, q);
    double sum = 0.0;
    for (std::size_t k = 1; k < at.size(); ++k)
        if (at[k] > at[k - 1])
            sum += quadrature.integrate([&](double l) { return inner(q, p.at(l)); }, at[k - 1],
                                        at[k], 1e-14);
    return sum;
}

}  // namespace

double contour_integral(std::span<const Point> p, std::span<const Point> q) {
    const auto p_edges = edges_of(p), q_edges = edges_of(q);
    double sum = 0.0;
    for (const Edge& a : p_edges)
        for (const Edge& b : q_edges)
            if (const double turn = glm::dot(a.along, b.along); std::abs(turn) > 1e-15)
                sum += turn * double_integral(a, b);
    return std::abs(sum) / (2.0 * std::numbers::pi);
}

}  // namespace tyndall::radiosity
